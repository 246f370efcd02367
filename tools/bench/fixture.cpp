#include "bench/fixture.h"

#include <filesystem>

#include "geometry/orientation_grid.h"
#include "geometry/symmetry.h"
#include "gles/references_gles.h"
#include "gles/stage_set_gles.h"
#include "io/camera_file.h"
#include "io/depth_file.h"
#include "io/mesh_file.h"
#include "sim/drop.h"
#include "sim/heap.h"
#include "sim/physics_part.h"
#include "sim/scanner.h"
#include "stages/reference_host.h"

namespace rangepose::bench {

struct Fixture::Views {
  int count = 0;
  ReferenceDatabase database;
  bool traced = false;
  Estimate estimate;
  EstimateTrace trace;
};

Fixture::Fixture() : host_(makeHostStages()) {
  paths_.push_back({host_->name, host_.get(), false});
  try {
    context_ = std::make_unique<gles::Context>();
    glsl_ = gles::makeGlesStages(*context_);
    paths_.push_back({glsl_->name, glsl_.get(), context_->info().software});
  } catch (const Unavailable& error) {
    no_gles_reason_ = error.what();
  }
  try {
    for (const bool staged : {false, true}) {
      cuda_.push_back(cuda::openPath({cuda::Interop::kAuto, staged}));
      paths_.push_back({staged ? "cuda_staged" : "cuda", cuda_.back().stages.get(), false});
    }
  } catch (const Unavailable& error) {
    no_cuda_reason_ = error.what();
  }
}

Fixture::~Fixture() = default;

const Mesh& Fixture::mesh() {
  if (!mesh_) {
    const std::filesystem::path models = RP_MODELS_DIR;
    mesh_ = std::make_unique<Mesh>(readMesh(models / "elbow.ply", LengthUnit::kMillimetre));
  }
  return *mesh_;
}

Fixture::Views& Fixture::views(int count) {
  for (const std::unique_ptr<Views>& known : views_) {
    if (known->count == count) return *known;
  }
  auto made = std::make_unique<Views>();
  made->count = count;
  const ChannelOptions options = channelOptionsFor(kSizePx);
  made->database.objects.push_back(
      describeObject(mesh(), 1, kSizePx, uniformRotations(count), options));
  setSymmetries(made->database.objects.front(), findSymmetries(mesh()));
  if (context_) {
    gles::renderReferences(*context_, made->database.objects.front(), options);
  } else {
    host::renderReferences(made->database.objects.front(), options, {});
  }
  views_.push_back(std::move(made));
  return *views_.back();
}

const ReferenceDatabase& Fixture::database(int count) { return views(count).database; }

const DepthImage& Fixture::demo() {
  if (!demo_) {
    const std::filesystem::path folder = std::filesystem::path(RP_MODELS_DIR) / "demo";
    demo_ = std::make_unique<DepthImage>(
        readDepth(folder / "depth.png", readCamera(folder / "camera.json")));
  }
  return *demo_;
}

const DepthImage& Fixture::heap() {
  if (!heap_) {
    HeapOptions heap_options;
    heap_options.count = 14;
    heap_options.seed = 7;
    ScannerOptions scanner;
    scanner.width = 848;
    scanner.height = 480;
    scanner.seed = 7;
    const std::vector<Mesh> meshes = {mesh()};
    heap_ = std::make_unique<DepthImage>(
        scanHeap(meshes, makeHeap(meshes, heap_options), scanner).image);
  }
  return *heap_;
}

const Fixture::Bin& Fixture::bin() {
  if (!bin_) {
    const std::vector<Mesh> meshes = {mesh()};
    DropOptions drop;
    drop.seed = 7;
    const DroppedBin dropped = dropParts({physicsPart(meshes.front())}, {25}, drop);
    const Scan scan = scanBin(meshes, dropped.parts, dropped.bin, {});
    bin_ = std::make_unique<Bin>(Bin{scan.image, binBox(dropped.bin, scan.camera_from_world)});
  }
  return *bin_;
}

const EstimateTrace& Fixture::trace(int count) {
  Views& known = views(count);
  if (!known.traced) {
    EstimateOptions options;
    options.starts = kStarts;
    known.estimate =
        estimatePoses(demo(), std::nullopt, known.database, options, *host_, &known.trace);
    known.traced = true;
  }
  return known.trace;
}

double Fixture::noiseMm() {
  constexpr int kAnyViews = 256;
  static_cast<void>(trace(kAnyViews));
  return views(kAnyViews).estimate.noise_mm;
}

Enclosure Fixture::enclosure(int count) {
  static_cast<void>(trace(count));
  const Views& known = views(count);
  return {demo(), known.estimate.background, std::nullopt, known.database, noiseMm()};
}

}  // namespace rangepose::bench
