#include "rangepose/bin_simulator.h"

#include <fmt/format.h>

#include <algorithm>
#include <iostream>
#include <numeric>
#include <utility>

#include "io/length_unit.h"
#include "io/mesh_file.h"
#include "rangepose/console.h"
#include "wear/wear.h"

namespace rangepose::cli {
namespace {

/// Numbers that have nothing to do with each other, for each bin and each use.
std::uint64_t derivedSeed(std::uint64_t seed, std::uint64_t bin, std::uint64_t use) {
  std::uint64_t x = seed;
  for (const std::uint64_t more : {bin, use}) {
    x = (x ^ (more + 0x9E3779B97F4A7C15u)) * 0xBF58476D1CE4E5B9u;
    x ^= x >> 29;
    x *= 0x94D049BB133111EBu;
    x ^= x >> 32;
  }
  return x;
}

/// How many of each model lie in a bin: all of one model, or as evenly as it goes.
std::vector<int> countsOf(const SimulateArguments& arguments, int bin) {
  const int models = static_cast<int>(arguments.models.size());
  std::vector<int> counts(arguments.models.size(), 0);
  if (!arguments.mixed) {
    counts[static_cast<std::size_t>(bin % models)] = arguments.count;
    return counts;
  }
  for (int k = 0; k < arguments.count; ++k) ++counts[static_cast<std::size_t>((bin + k) % models)];
  return counts;
}

/// `least`, or the finest coarser one of 0.001, 0.002, 0.005, 0.01 ... mm, that leaves 16 bits for
/// `far_mm`.
double depthScaleFor(double far_mm, double least) {
  if (far_mm <= least * 65535.0) return least;
  constexpr double kSteps[] = {1.0, 2.0, 5.0};
  double decade = 1e-3;
  for (int k = 0;; ++k) {
    const double scale = decade * kSteps[k % 3];
    if (scale >= least * 0.999 && far_mm <= scale * 65535.0) return scale;
    if (k % 3 == 2) decade *= 10.0;
  }
}

/// What is left of a bin when `images` are taken while it is emptied evenly, the highest parts
/// first, by the middle of each; in the order in which they fell.
std::vector<PlacedPart> partsLeft(const std::vector<Mesh>& meshes,
                                  const std::vector<PlacedPart>& parts,
                                  int image,
                                  int images) {
  std::vector<double> height_mm;
  for (const PlacedPart& part : parts) {
    const Sphere sphere = boundingSphere(meshes[static_cast<std::size_t>(part.mesh)]);
    height_mm.push_back((part.world_from_object * sphere.center_mm).z);
  }
  std::vector<std::size_t> order(parts.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return height_mm[a] < height_mm[b];
  });
  const auto whole = static_cast<int>(parts.size());
  const int left = std::max(1, whole * (images - image) / images);
  order.resize(static_cast<std::size_t>(left));
  std::sort(order.begin(), order.end());
  std::vector<PlacedPart> result;
  for (const std::size_t index : order) result.push_back(parts[index]);
  return result;
}

}  // namespace

BinSimulator::BinSimulator(const SimulateArguments& arguments)
    : arguments_(arguments), out_(arguments.out) {
  const LengthUnit unit = parseLengthUnit(arguments.unit);
  for (const std::string& path : arguments.models) meshes_.push_back(readMesh(path, unit));
}

void BinSimulator::writeModels() {
  std::cout << fmt::format(
      "{:>6}  {:<20} {:>12} {:>6}  {}\n", "obj_id", "name", "diameter[mm]", "pieces", "symmetry");
  std::vector<BopMesh> models;
  for (const Mesh& mesh : meshes_) {
    parts_.push_back(physicsPart(mesh));
    const Symmetries symmetries = findSymmetries(mesh);
    describe(parts_.back(), symmetries);
    BopModelInfo info;
    info.diameter_mm = parts_.back().diameter_mm;
    info.symmetries_discrete = symmetries.discrete;
    for (const SymmetryAxis& axis : symmetries.continuous) {
      info.symmetries_continuous.push_back({axis.direction, axis.point_mm});
    }
    models.push_back({mesh, std::move(info)});
  }
  writeBopModels(out_ / "models", models);
}

void BinSimulator::describe(const PhysicsPart& part, const Symmetries& symmetries) const {
  std::cout << fmt::format("{:>6}  {:<20} {:>12.2f} {:>6}  {}\n",
                           parts_.size(),
                           part.name,
                           part.diameter_mm,
                           part.pieces.size(),
                           symmetryName(symmetries))
            << std::flush;
  if (!part.closed) {
    printWarning("object " + part.name +
                 " is not closed: its mass is taken as that of its convex hull");
  }
  constexpr double kSmallestMm = 1.0;
  constexpr double kLargestMm = 5000.0;
  if (part.diameter_mm < kSmallestMm || part.diameter_mm > kLargestMm) {
    printWarning(
        fmt::format("object {} is {:.6g} mm wide: smells of a unit error; read as --unit {}",
                    part.name,
                    part.diameter_mm,
                    arguments_.unit));
  }
}

void BinSimulator::makeBin(int bin, const std::atomic<bool>& stop) {
  const auto number = static_cast<std::uint64_t>(bin);
  DropOptions drop = arguments_.drop;
  drop.seed = derivedSeed(arguments_.seed, number, 1);
  const DroppedBin dropped = dropParts(parts_, countsOf(arguments_, bin), drop);
  if (stop) return;
  ScannerOptions scanner = arguments_.scanner;
  scanner.seed = derivedSeed(arguments_.seed, number, 2);
  scanner.sensor = sensorModel(arguments_.sensor);
  if (scanner.distance_mm == 0.0) scanner.distance_mm = distanceFor(dropped.bin, scanner);
  const double far_mm = 1.5 * (scanner.distance_mm + glm::length(dropped.bin.inner_mm));
  const bool exact = scanner.sensor.kind == SensorKind::kNone;
  scanner.depth_scale = depthScaleFor(far_mm, exact ? 1e-3 : scanner.sensor.depth_scale);
  const Contents contents = contentsOf(dropped, derivedSeed(arguments_.seed, number, 3));
  std::vector<BopView> views;
  for (int image = 0; image < arguments_.images; ++image) {
    if (stop) return;
    const std::vector<PlacedPart> left =
        partsLeft(contents.meshes, contents.parts, image, arguments_.images);
    const Scan scan = scanBin(contents.meshes, left, dropped.bin, scanner, contents.shiny);
    views.push_back(viewOf(image, dropped.bin, contents, scan));
    ++scanner.seed;
  }
  write(bin + 1, views);
}

BinSimulator::Contents BinSimulator::contentsOf(const DroppedBin& dropped,
                                                std::uint64_t seed) const {
  Contents contents;
  contents.parts = dropped.parts;
  if (!arguments_.wear) {
    contents.meshes = meshes_;
    for (std::size_t k = 0; k < meshes_.size(); ++k) contents.models.push_back(static_cast<int>(k));
    return contents;
  }
  for (std::size_t k = 0; k < contents.parts.size(); ++k) {
    const int model = contents.parts[k].mesh;
    WornPart worn = wornPart(meshes_[static_cast<std::size_t>(model)], {}, derivedSeed(seed, k, 1));
    contents.meshes.push_back(std::move(worn.mesh));
    contents.shiny.push_back(std::move(worn.shiny));
    contents.models.push_back(model);
    contents.parts[k].mesh = static_cast<int>(k);
  }
  return contents;
}

BopView BinSimulator::viewOf(int im_id,
                             const BinShape& bin,
                             const Contents& contents,
                             const Scan& scan) const {
  BopView view;
  view.im_id = im_id;
  view.image = scan.image;
  view.camera_from_world = scan.camera_from_world;
  view.bin = binBox(bin, scan.camera_from_world);
  for (const PartTruth& part : scan.truth) {
    view.parts.push_back({contents.models[static_cast<std::size_t>(part.mesh)] + 1,
                          part.camera_from_object,
                          part.visible_fraction,
                          part.all_px,
                          part.measured_px,
                          part.visible_px,
                          part.all_box,
                          part.visible_box});
  }
  return view;
}

void BinSimulator::write(int scene_id, const std::vector<BopView>& views) {
  writeBopScene(out_ / "test" / fmt::format("{:06}", scene_id), views);
  std::vector<BopTarget> targets;
  for (const BopView& view : views) {
    const std::vector<BopTarget> more = targetsOf(scene_id, view);
    targets.insert(targets.end(), more.begin(), more.end());
  }
  const std::lock_guard<std::mutex> lock(mutex_);
  scenes_.push_back({scene_id, views.front().image.camera, std::move(targets)});
}

void BinSimulator::finish() {
  std::sort(scenes_.begin(), scenes_.end(), [](const SceneFacts& a, const SceneFacts& b) {
    return a.scene_id < b.scene_id;
  });
  std::vector<BopTarget> targets;
  for (const SceneFacts& scene : scenes_) {
    targets.insert(targets.end(), scene.targets.begin(), scene.targets.end());
  }
  writeBopCamera(out_ / "camera.json", scenes_.at(0).camera);
  writeBopTargets(out_ / "test_targets_bop19.json", targets);
}

}  // namespace rangepose::cli
