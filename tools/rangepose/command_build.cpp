// rangepose build: CAD models in, reference database out.
#include <fmt/format.h>

#include <chrono>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "core/parallel.h"
#include "database/reference_database.h"
#include "geometry/symmetry.h"
#include "gles/references_gles.h"
#include "io/atomic_file.h"
#include "io/bop.h"
#include "io/mesh_file.h"
#include "io/mesh_simplify.h"
#include "pipeline/path_choice.h"
#include "rangepose/build_views.h"
#include "rangepose/command.h"
#include "rangepose/console.h"
#include "rangepose/progress.h"
#include "stages/reference_host.h"

namespace rangepose::cli {
namespace {

constexpr const char* kExamples = R"(Examples:
  rangepose build models/elbow.ply -o parts.rpdb
  rangepose build a.stl b.obj -o parts.rpdb --unit m --views 2048
  rangepose build a.stl -o a.rpdb --sampling adaptive       views as the part comes to lie in bins
  rangepose build --bop lm -o lm.rpdb         all models of a BOP data set, with their ids)";

struct BuildArguments {
  std::vector<std::string> models;
  std::string bop;
  std::string out;
  int views = 1024;
  int size = 64;
  std::string sampling = "uniform";
  int bins = 0;
  std::string statistics;
  std::string unit = "mm";
  double simplify = 2e-4;
  std::string path = "auto";
  int threads = 0;
};

struct ModelFile {
  int id = 0;
  std::filesystem::path path;
  std::optional<Symmetries> symmetries;  ///< as models_info.json has them
};

std::optional<Symmetries> givenSymmetries(const BopModel& model) {
  if (!model.info) return std::nullopt;
  Symmetries symmetries;
  symmetries.discrete = model.info->symmetries_discrete;
  for (const BopContinuousSymmetry& line : model.info->symmetries_continuous) {
    symmetries.continuous.push_back({line.axis, line.offset_mm});
  }
  return symmetries;
}

std::vector<ModelFile> modelFiles(const BuildArguments& arguments) {
  std::vector<ModelFile> files;
  if (arguments.bop.empty()) {
    for (const std::string& model : arguments.models) {
      files.push_back({static_cast<int>(files.size()) + 1, model, std::nullopt});
    }
    return files;
  }
  for (const BopModel& model : openBop(arguments.bop).models) {
    files.push_back({model.obj_id, model.mesh_path, givenSymmetries(model)});
  }
  if (files.empty()) {
    throw Error("BOP data set " + arguments.bop +
                ": has no models; expected models/obj_000001.ply");
  }
  return files;
}

void warnAboutSize(const ReferenceObject& object, const std::string& unit) {
  constexpr double kSmallestMm = 1.0;
  constexpr double kLargestMm = 5000.0;
  if (object.diameter_mm >= kSmallestMm && object.diameter_mm <= kLargestMm) return;
  printWarning(fmt::format("object {} is {:.6g} mm wide: smells of a unit error; read as --unit {}",
                           object.mesh.name,
                           object.diameter_mm,
                           unit));
}

/// Of "auto" the host, whose views are the same on every machine: drivers round outlines to 1/256
/// px and ranges to floats, each in its own way, and one bit of a view may decide between poses
/// that are about as likely.
PathRequest rendererOf(const std::string& path) {
  const PathRequest request = parsePathRequest(path);
  return request == PathRequest::kAuto ? PathRequest::kHost : request;
}

double secondsSince(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

/// How many other ways round a part is nearly the same: poses that often compete.
std::string twinsNote(const ReferenceObject& object) {
  const std::size_t twins = object.twins.size();
  return twins == 0 ? "" : fmt::format(", {} twin{}", twins, twins == 1 ? "" : "s");
}

class Builder {
 public:
  explicit Builder(const BuildArguments& arguments)
      : arguments_(arguments), context_(openContext(rendererOf(arguments.path), false)) {
    request_.adaptive = arguments.sampling == "adaptive";
    request_.views = arguments.views;
    request_.bins = arguments.bins;
    request_.folder = std::filesystem::path(arguments.out).parent_path();
    request_.picture_dir = arguments.statistics;
  }

  std::string pathName() const {
    return context_ != nullptr ? "glsl (" + context_->info().renderer + ")" : "host";
  }

  ReferenceObject build(const ModelFile& file) {
    const auto begin = std::chrono::steady_clock::now();
    Mesh mesh = readMesh(file.path, parseLengthUnit(arguments_.unit));
    const ChannelOptions options = channelOptionsFor(arguments_.size);
    const Symmetries symmetries = file.symmetries ? *file.symmetries : findSymmetries(mesh);
    if (file.symmetries && symmetries.none()) warnAboutSymmetries(file, mesh);
    const ChosenViews chosen = chooseViews(request_, file.path, mesh, symmetries);
    if (!chosen.note.empty()) notes_.push_back(chosen.note);
    ReferenceObject object =
        describeObject(withoutDetail(mesh), file.id, arguments_.size, chosen.rotations, options);
    setSymmetries(object, symmetries);
    warnAboutSize(object, arguments_.unit);
    render(object, options);
    std::cout << fmt::format("{:>6}  {:<20} {:>9} {:>12.2f} {:>9.3f} {:>6} {:>8.2f}  {}{}\n",
                             object.id,
                             object.mesh.name,
                             object.mesh.triangles.size(),
                             object.diameter_mm,
                             object.pixel_mm,
                             object.views.size(),
                             secondsSince(begin),
                             symmetryName(symmetries) + twinsNote(object),
                             file.symmetries ? " (models_info.json)" : "")
              << std::flush;
    return object;
  }

  /// Where the views come from, a line an object.
  const std::vector<std::string>& notes() const { return notes_; }

 private:
  /// What follows from the shape itself comes from all of its triangles, what is rendered from
  /// these.
  Mesh withoutDetail(const Mesh& mesh) {
    const double error_mm = arguments_.simplify * diameter(mesh);
    const Progress progress(
        std::cerr, mesh.name + ": needless triangles left out", 0, terminalProgress());
    Mesh result = simplified(mesh, error_mm);
    if (result.triangles.size() < mesh.triangles.size()) {
      notes_.push_back(
          fmt::format("{}: {} of {} triangles are enough for its surface to within {:.2g} mm",
                      mesh.name,
                      result.triangles.size(),
                      mesh.triangles.size(),
                      error_mm));
    }
    return result;
  }

  static void warnAboutSymmetries(const ModelFile& file, const Mesh& mesh) {
    const Symmetries found = findSymmetries(mesh);
    if (found.none()) return;
    printWarning(file.path.string() + ": models_info.json names no symmetry, but the mesh has " +
                 symmetryName(found) +
                 "; poses that look the same will share their score, unless it is added there");
  }

  void render(ReferenceObject& object, const ChannelOptions& options) {
    const int views = static_cast<int>(object.views.size());
    Progress progress(std::cerr, object.mesh.name, views, terminalProgress());
    const auto report = [&progress](int done, int) { progress.update(done); };
    if (context_ != nullptr) {
      gles::renderReferences(*context_, object, options, report);
    } else {
      host::renderReferences(object, options, report);
    }
  }

  const BuildArguments& arguments_;
  std::unique_ptr<gles::Context> context_;
  ViewRequest request_;
  std::vector<std::string> notes_;
};

void warnAboutNames(const ReferenceDatabase& database) {
  std::set<std::string> names;
  for (const ReferenceObject& object : database.objects) {
    if (names.insert(object.mesh.name).second) continue;
    printWarning("several objects are named " + object.mesh.name +
                 "; only their ids tell them apart");
  }
}

void checkUsage(const BuildArguments& arguments) {
  if (arguments.models.empty() == arguments.bop.empty()) {
    throw UsageError(arguments.bop.empty() ? "no model given; name mesh files or --bop DIR"
                                           : "give either mesh files or --bop DIR, not both");
  }
  if (arguments.sampling == "adaptive") return;
  if (arguments.bins != 0 || !arguments.statistics.empty()) {
    throw UsageError("--bins and --statistics need --sampling adaptive");
  }
}

void checkPictureFolder(const std::string& folder) {
  if (folder.empty()) return;
  std::error_code failure;
  std::filesystem::create_directories(folder, failure);
  checkOutputFile(std::filesystem::path(folder) / "poses.png");
}

int build(const BuildArguments& arguments) {
  checkUsage(arguments);
  const auto begin = std::chrono::steady_clock::now();
  checkOutputFile(arguments.out);
  checkPictureFolder(arguments.statistics);
  setThreadCount(arguments.threads);
  const std::vector<ModelFile> files = modelFiles(arguments);
  Builder builder(arguments);
  std::cout << "rendering by " << builder.pathName() << '\n'
            << fmt::format("{:>6}  {:<20} {:>9} {:>12} {:>9} {:>6} {:>8}  {}\n",
                           "obj_id",
                           "name",
                           "triangles",
                           "diameter[mm]",
                           "pixel[mm]",
                           "views",
                           "time[s]",
                           "symmetry");
  ReferenceDatabase database;
  for (const ModelFile& file : files) database.objects.push_back(builder.build(file));
  for (const std::string& note : builder.notes()) std::cout << note << '\n';
  warnAboutNames(database);
  const std::vector<char> bytes = serialize(database);
  writeFileAtomically(arguments.out, std::string_view(bytes.data(), bytes.size()));
  std::cout << fmt::format("{}: {:.1f} MB, {} object{}, {:.2f} s\n",
                           arguments.out,
                           static_cast<double>(bytes.size()) / 1e6,
                           database.objects.size(),
                           database.objects.size() == 1 ? "" : "s",
                           secondsSince(begin));
  return kDone;
}

}  // namespace

std::function<int()> declareBuild(CLI::App& command) {
  const auto arguments = std::make_shared<BuildArguments>();
  command.footer(kExamples);
  command
      .add_option("models",
                  arguments->models,
                  "Meshes: PLY, STL, OBJ, OFF, glTF ...; ids 1, 2, ... in this order")
      ->option_text("MODEL...");
  command
      .add_option("--bop", arguments->bop, "All models of this BOP data set, with their object ids")
      ->option_text("DIR");
  command.add_option("-o,--out", arguments->out, "Database to write")
      ->required()
      ->option_text("FILE");
  command.add_option("--views", arguments->views, "Orientations of each object")
      ->check(CLI::Range(1, 65536))
      ->capture_default_str();
  command.add_option("--size", arguments->size, "Width of a view [px]")
      ->check(CLI::Range(16, 128))
      ->capture_default_str();
  command
      .add_option("--sampling",
                  arguments->sampling,
                  "Orientations: uniform, or adaptive: dense where the part comes to lie in bins")
      ->check(CLI::IsMember({"uniform", "adaptive"}))
      ->capture_default_str();
  command
      .add_option(
          "--bins",
          arguments->bins,
          "Bins to simulate for --sampling adaptive [500]; not needed where NAME.poses lies "
          "beside the mesh or the database")
      ->check(CLI::Range(1, 100000));
  command
      .add_option("--statistics",
                  arguments->statistics,
                  "Write pictures of how the parts come to lie into this folder")
      ->option_text("DIR");
  command.add_option("--unit", arguments->unit, "Of the meshes")
      ->check(CLI::IsMember({"mm", "m", "inch"}))
      ->capture_default_str();
  command
      .add_option("--simplify",
                  arguments->simplify,
                  "Leave out triangles that change the surface by less than this share of the "
                  "diameter; 0: none")
      ->check(CLI::Range(0.0, 0.01))
      ->option_text("SHARE [0.0002]");
  command
      .add_option("--path",
                  arguments->path,
                  "What renders; auto: host, whose database is the same on all machines")
      ->check(CLI::IsMember({"auto", "glsl", "host", "cuda"}))
      ->capture_default_str();
  command.add_option("--threads", arguments->threads, "Of the host; 0: all cores")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  return [arguments] { return build(*arguments); };
}

}  // namespace rangepose::cli
