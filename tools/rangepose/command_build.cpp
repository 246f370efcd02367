// rangepose build: CAD models in, reference database out.
#include <fmt/format.h>

#include <chrono>
#include <filesystem>
#include <iostream>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "core/parallel.h"
#include "database/reference_database.h"
#include "geometry/orientation_grid.h"
#include "gles/references_gles.h"
#include "io/atomic_file.h"
#include "io/bop.h"
#include "io/mesh_file.h"
#include "pipeline/path_choice.h"
#include "rangepose/command.h"
#include "rangepose/console.h"
#include "rangepose/progress.h"
#include "stages/reference_host.h"

namespace rangepose::cli {
namespace {

constexpr const char* kExamples = R"(Examples:
  rangepose build models/elbow.ply -o parts.rpdb
  rangepose build a.stl b.obj -o parts.rpdb --unit m --views 2048
  rangepose build --bop lm -o lm.rpdb         all models of a BOP data set, with their ids)";

struct BuildArguments {
  std::vector<std::string> models;
  std::string bop;
  std::string out;
  int views = 1024;
  int size = 64;
  std::string sampling = "uniform";
  std::string unit = "mm";
  std::string path = "auto";
  int threads = 0;
};

struct ModelFile {
  int id = 0;
  std::filesystem::path path;
};

std::vector<ModelFile> modelFiles(const BuildArguments& arguments) {
  std::vector<ModelFile> files;
  if (arguments.bop.empty()) {
    for (const std::string& model : arguments.models) {
      files.push_back({static_cast<int>(files.size()) + 1, model});
    }
    return files;
  }
  for (const BopModel& model : openBop(arguments.bop).models) {
    files.push_back({model.obj_id, model.mesh_path});
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

double secondsSince(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

class Builder {
 public:
  explicit Builder(const BuildArguments& arguments)
      : arguments_(arguments),
        context_(openContext(parsePathRequest(arguments.path), false)),
        rotations_(uniformRotations(arguments.views)) {}

  std::string pathName() const {
    return context_ != nullptr ? "glsl (" + context_->info().renderer + ")" : "host";
  }

  ReferenceObject build(const ModelFile& file) {
    const auto begin = std::chrono::steady_clock::now();
    Mesh mesh = readMesh(file.path, parseLengthUnit(arguments_.unit));
    const ChannelOptions options = channelOptionsFor(arguments_.size);
    ReferenceObject object = describeObject(mesh, file.id, arguments_.size, rotations_, options);
    warnAboutSize(object, arguments_.unit);
    {
      Progress progress(std::cerr, object.mesh.name, arguments_.views, terminalProgress());
      const auto report = [&progress](int done, int) { progress.update(done); };
      if (context_ != nullptr) {
        gles::renderReferences(*context_, object, options, report);
      } else {
        host::renderReferences(object, options, report);
      }
    }
    std::cout << fmt::format("{:>6}  {:<20} {:>9} {:>12.2f} {:>9.3f} {:>6} {:>8.2f}\n",
                             object.id,
                             object.mesh.name,
                             object.mesh.triangles.size(),
                             object.diameter_mm,
                             object.pixel_mm,
                             object.views.size(),
                             secondsSince(begin))
              << std::flush;
    return object;
  }

 private:
  const BuildArguments& arguments_;
  std::unique_ptr<gles::Context> context_;
  std::vector<glm::dmat3> rotations_;
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
  if (arguments.sampling == "adaptive") {
    throw UsageError(
        "--sampling adaptive is not available in this version; use --sampling uniform");
  }
  if (arguments.sampling != "uniform") {
    throw UsageError("--sampling " + arguments.sampling + " is unknown; use --sampling uniform");
  }
}

int build(const BuildArguments& arguments) {
  checkUsage(arguments);
  const auto begin = std::chrono::steady_clock::now();
  checkOutputFile(arguments.out);
  setThreadCount(arguments.threads);
  const std::vector<ModelFile> files = modelFiles(arguments);
  Builder builder(arguments);
  std::cout << "rendering by " << builder.pathName() << '\n'
            << fmt::format("{:>6}  {:<20} {:>9} {:>12} {:>9} {:>6} {:>8}\n",
                           "obj_id",
                           "name",
                           "triangles",
                           "diameter[mm]",
                           "pixel[mm]",
                           "views",
                           "time[s]");
  ReferenceDatabase database;
  for (const ModelFile& file : files) database.objects.push_back(builder.build(file));
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
  command.add_option("--sampling", arguments->sampling, "How orientations are chosen: uniform")
      ->capture_default_str();
  command.add_option("--unit", arguments->unit, "Of the meshes")
      ->check(CLI::IsMember({"mm", "m", "inch"}))
      ->capture_default_str();
  command.add_option("--path", arguments->path, "What renders; auto: glsl where there is EGL")
      ->check(CLI::IsMember({"auto", "glsl", "host", "cuda"}))
      ->capture_default_str();
  command.add_option("--threads", arguments->threads, "Of the host; 0: all cores")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  return [arguments] { return build(*arguments); };
}

}  // namespace rangepose::cli
