// rangepose_heap: makes a heap of parts, scans it, and writes the depth image with its truth.
#include <CLI/CLI.hpp>
#include <charconv>
#include <exception>
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/error.h"
#include "io/atomic_file.h"
#include "io/depth_file.h"
#include "io/length_unit.h"
#include "io/mesh_file.h"
#include "sim/heap.h"
#include "sim/scanner.h"

namespace rangepose {
namespace {

struct Arguments {
  std::vector<std::string> meshes;
  std::string out;
  std::string unit = "mm";
  std::string size;  ///< empty: that of the sensor
  std::string sensor = "structured-light";
  std::uint64_t seed = 1;
  double tilt_deg = 15.0;
  HeapOptions heap;
  ScannerOptions scanner;
};

/// "640x480"; false where the text is anything else.
bool parseSize(const std::string& text, int& width, int& height) {
  const char* const end = text.data() + text.size();
  const auto first = std::from_chars(text.data(), end, width);
  if (first.ec != std::errc() || first.ptr == end || *first.ptr != 'x') return false;
  const auto second = std::from_chars(first.ptr + 1, end, height);
  return second.ec == std::errc() && second.ptr == end;
}

void declareOptions(CLI::App& app, Arguments& arguments) {
  HeapOptions& heap = arguments.heap;
  ScannerOptions& scanner = arguments.scanner;
  app.add_option("meshes", arguments.meshes, "Parts; they take turns")->required();
  app.add_option("-o,--out", arguments.out, "Folder to write to")->required();
  app.add_option("--unit", arguments.unit, "Of the meshes")
      ->check(CLI::IsMember({"mm", "m", "inch"}));
  app.add_option("--count", heap.count, "Parts in the heap");
  app.add_option("--seed", arguments.seed, "Same seed, same files");
  app.add_option("--radius", heap.radius_mm, "Of the heap [mm]; 0: from the parts");
  app.add_option("--sensor", arguments.sensor, "What takes the image")
      ->check(CLI::IsMember(sensorNames()));
  app.add_option("--camera-distance", scanner.distance_mm, "To the middle of the heap [mm]");
  app.add_option("--tilt", arguments.tilt_deg, "Of the view from straight down [degrees]")
      ->check(CLI::Range(0.0, 57.0));
  app.add_option("--size", arguments.size, "Of the image, WIDTHxHEIGHT; else that of the sensor")
      ->check([](const std::string& text) {
        int width = 0;
        int height = 0;
        return parseSize(text, width, height) ? std::string() : text + " is not WIDTHxHEIGHT";
      });
}

nlohmann::ordered_json cameraJson(const Camera& camera) {
  return {{"cam_K", {camera.fx, 0.0, camera.cx, 0.0, camera.fy, camera.cy, 0.0, 0.0, 1.0}},
          {"depth_scale", camera.depth_scale},
          {"width", camera.width},
          {"height", camera.height}};
}

nlohmann::ordered_json truthJson(const Scan& scan, const std::vector<Mesh>& meshes) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const PartTruth& part : scan.truth) {
    const glm::dmat3 by_row = glm::transpose(part.camera_from_object.rotation);
    const glm::dvec3& t = part.camera_from_object.translation_mm;
    nlohmann::ordered_json rotation = nlohmann::ordered_json::array();
    for (int k = 0; k < 9; ++k) rotation.push_back(by_row[k / 3][k % 3]);
    list.push_back({{"obj", meshes.at(static_cast<std::size_t>(part.mesh)).name},
                    {"cam_R_m2c", rotation},
                    {"cam_t_m2c", {t.x, t.y, t.z}},
                    {"visible_fraction", part.visible_fraction}});
  }
  return list;
}

/// One entry a line.
std::string lines(const nlohmann::ordered_json& list) {
  std::string text = "[";
  for (const auto& entry : list) text += (text.size() > 1 ? ",\n " : "\n ") + entry.dump();
  return text + "\n]\n";
}

void makeScan(Arguments& arguments) {
  const LengthUnit unit = parseLengthUnit(arguments.unit);
  std::vector<Mesh> meshes;
  meshes.reserve(arguments.meshes.size());
  for (const std::string& path : arguments.meshes) meshes.push_back(readMesh(path, unit));
  ScannerOptions& scanner = arguments.scanner;
  scanner.sensor = sensorModel(arguments.sensor);
  if (!arguments.size.empty()) parseSize(arguments.size, scanner.width, scanner.height);
  scanner.tilt_rad = arguments.tilt_deg * 3.14159265358979323846 / 180.0;
  scanner.seed = arguments.seed;
  scanner.check();
  arguments.heap.seed = arguments.seed;
  const Scan scan = scanHeap(meshes, makeHeap(meshes, arguments.heap), scanner);

  const std::filesystem::path out = arguments.out;
  std::filesystem::create_directories(out);
  writeDepthPng(out / "depth.png", scan.image);
  writeFileAtomically(out / "camera.json", cameraJson(scan.image.camera).dump() + "\n");
  writeFileAtomically(out / "ground_truth.json", lines(truthJson(scan, meshes)));
  std::cout << scan.truth.size() << " parts in " << out.string()
            << ": depth.png, camera.json, ground_truth.json\n";
}

}  // namespace
}  // namespace rangepose

int main(int argc, char** argv) {
  try {
    CLI::App app("Makes a heap of parts and a depth image of it, with the true poses.");
    app.option_defaults()->always_capture_default();
    rangepose::Arguments arguments;
    rangepose::declareOptions(app, arguments);
    try {
      app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
      return app.exit(error) == 0 ? 0 : 2;
    }
    rangepose::makeScan(arguments);
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "rangepose_heap: " << error.what() << '\n';
    return 1;
  }
}
