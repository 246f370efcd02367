#include "rangepose/scene_input.h"

#include <cmath>

#include "io/camera_file.h"
#include "io/cloud_file.h"
#include "io/depth_file.h"
#include "io/length_unit.h"
#include "rangepose/command.h"

namespace rangepose::cli {

void declareScene(CLI::App& command, SceneArguments& arguments) {
  command.add_option("--db", arguments.database, "Reference database, see rangepose build")
      ->required()
      ->option_text("FILE");
  command
      .add_option("--depth", arguments.depth, "Depth image: 16-bit PNG or TIFF, float TIFF or EXR")
      ->option_text("FILE");
  command.add_option("--cloud", arguments.cloud, "Point cloud in the camera frame: PLY or PCD")
      ->option_text("FILE");
  command
      .add_option(
          "--camera", arguments.camera, "Camera (JSON): cam_K, depth_scale; for --cloud optional")
      ->option_text("FILE");
  command
      .add_option(
          "--bin", arguments.bin, "Region of interest (JSON): cam_R_bin2c, cam_t_bin2c, inner_size")
      ->option_text("FILE");
  command.add_option("--unit", arguments.unit, "Of the cloud (default m)")
      ->check(CLI::IsMember({"mm", "m", "inch"}));
}

void checkScene(const SceneArguments& arguments) {
  if (!arguments.given()) throw UsageError("no scene given; use --depth FILE or --cloud FILE");
  if (!arguments.depth.empty() && !arguments.cloud.empty()) {
    throw UsageError("--depth and --cloud exclude each other; give one of them");
  }
  if (!arguments.depth.empty() && arguments.camera.empty()) {
    throw UsageError("--depth needs --camera FILE");
  }
  if (!arguments.unit.empty() && arguments.cloud.empty()) {
    throw UsageError(
        "--unit belongs to --cloud; the unit of a depth image is depth_scale in its camera file");
  }
}

DepthImage readScene(const SceneArguments& arguments) {
  if (!arguments.depth.empty()) return readDepth(arguments.depth, readCamera(arguments.camera));
  const LengthUnit unit = parseLengthUnit(arguments.unit.empty() ? "m" : arguments.unit);
  std::optional<Camera> camera;
  if (!arguments.camera.empty()) camera = readCamera(arguments.camera);
  return depthFromCloud(readCloud(arguments.cloud, unit), camera);
}

std::optional<BinBox> readBin(const SceneArguments& arguments) {
  if (arguments.bin.empty()) return std::nullopt;
  return readBinBox(arguments.bin);
}

CLI::Validator shareValidator() {
  const auto check = [](const std::string& text) {
    double value = 0.0;
    const bool good = CLI::detail::lexical_cast(text, value) && value >= 0.0 && value <= 1.0;
    return good ? std::string() : text + " is not a number from 0 to 1";
  };
  return CLI::Validator(check, "0..1");
}

}  // namespace rangepose::cli
