#include "io/camera_file.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <vector>

#include "core/error.h"
#include "io/json_fields.h"

namespace rangepose {
namespace {

using nlohmann::json;

constexpr int kMaxSidePx = 65535;

void readSize(const json& object, const std::string& where, Camera& camera) {
  if (!object.contains("width") && !object.contains("height")) return;
  camera.width = jsonInteger(object, "width", 1, kMaxSidePx, where);
  camera.height = jsonInteger(object, "height", 1, kMaxSidePx, where);
  if (camera.width > kMaxImagePixels / camera.height) {
    throw Error(fmt::format("{}: fields \"width\" and \"height\" give {}x{}, more than {} pixels",
                            where,
                            camera.width,
                            camera.height,
                            kMaxImagePixels));
  }
}

void readMatrix(const json& object, const std::string& where, Camera& camera) {
  const std::vector<double> k = jsonNumbers(object, "cam_K", 9, where);
  const std::string field = where + ": field \"cam_K\" ";
  if (k[6] != 0.0 || k[7] != 0.0 || k[8] != 1.0) {
    throw Error(field + "must have 0 0 1 as its last row");
  }
  if (k[3] != 0.0) throw Error(field + "must have 0 as the first number of its second row");
  if (k[1] != 0.0) throw Error(field + "has skew, which is not supported; rectify the image");
  camera.fx = k[0];
  camera.fy = k[4];
  camera.cx = k[2];
  camera.cy = k[5];
}

void readPinhole(const json& object, const std::string& where, Camera& camera) {
  if (object.contains("cam_K") || !object.contains("fx")) {
    readMatrix(object, where, camera);
  } else {
    camera.fx = jsonNumber(object, "fx", where);
    camera.fy = jsonNumber(object, "fy", where);
    camera.cx = jsonNumber(object, "cx", where);
    camera.cy = jsonNumber(object, "cy", where);
  }
  if (!(camera.fx > 0.0) || !(camera.fy > 0.0)) {
    throw Error(where + ": field \"cam_K\" is singular: focal lengths must be positive");
  }
}

void readOrthographic(const json& object, const std::string& where, Camera& camera) {
  camera.orthographic = true;
  camera.pixel_size_mm = jsonNumber(object, "pixel_size", where);
  if (!(camera.pixel_size_mm > 0.0)) {
    throw Error(where + ": field \"pixel_size\" must be positive (mm)");
  }
  camera.cx = std::numeric_limits<double>::quiet_NaN();
  camera.cy = std::numeric_limits<double>::quiet_NaN();
  if (object.contains("cam_K")) readMatrix(object, where, camera);
  if (object.contains("cx")) camera.cx = jsonNumber(object, "cx", where);
  if (object.contains("cy")) camera.cy = jsonNumber(object, "cy", where);
}

/// An orthographic scan without a centre has it in the middle of the image.
void centreWhereUnset(Camera& camera) {
  if (!camera.orthographic || camera.width == 0) return;
  if (std::isnan(camera.cx)) camera.cx = 0.5 * (camera.width - 1);
  if (std::isnan(camera.cy)) camera.cy = 0.5 * (camera.height - 1);
}

}  // namespace

Camera cameraFromJson(const json& object, const std::string& where) {
  if (!object.is_object()) throw Error(where + ": a JSON object {...} is expected");
  Camera camera;
  readSize(object, where, camera);
  if (object.contains("depth_scale")) {
    camera.depth_scale = jsonNumber(object, "depth_scale", where);
    if (!(camera.depth_scale > 0.0)) {
      throw Error(where + ": field \"depth_scale\" must be positive");
    }
  }
  if (object.contains("error_mm")) {
    camera.error_mm = jsonNumber(object, "error_mm", where);
    if (!(camera.error_mm > 0.0)) throw Error(where + ": field \"error_mm\" must be positive");
  }
  bool orthographic = false;
  if (const auto found = object.find("orthographic"); found != object.end()) {
    if (!found->is_boolean()) throw Error(where + ": field \"orthographic\" must be true or false");
    orthographic = found->get<bool>();
  }
  if (orthographic) {
    readOrthographic(object, where, camera);
  } else {
    readPinhole(object, where, camera);
  }
  centreWhereUnset(camera);
  return camera;
}

BinBox binBoxFromJson(const json& object, const std::string& where) {
  if (!object.is_object()) throw Error(where + ": a JSON object {...} is expected");
  BinBox bin;
  bin.camera_from_bin.rotation = rotationFromRows(jsonNumbers(object, "cam_R_bin2c", 9, where),
                                                  where + ": field \"cam_R_bin2c\"");
  const std::vector<double> t = jsonNumbers(object, "cam_t_bin2c", 3, where);
  bin.camera_from_bin.translation_mm = {t[0], t[1], t[2]};
  const std::vector<double> size = jsonNumbers(object, "inner_size", 3, where);
  bin.inner_size_mm = {size[0], size[1], size[2]};
  if (!(size[0] > 0.0) || !(size[1] > 0.0) || !(size[2] > 0.0)) {
    throw Error(where + ": field \"inner_size\" must have three positive lengths (mm)");
  }
  return bin;
}

Camera parseCamera(const std::string& json_text, const std::string& where) {
  return cameraFromJson(parseJsonObject(json_text, where), where);
}

Camera readCamera(const std::filesystem::path& path) {
  return cameraFromJson(readJsonFile(path, "camera file"), "camera file " + path.string());
}

Camera withImageSize(const Camera& camera, int width, int height, const std::string& where) {
  if (camera.width != 0 && (camera.width != width || camera.height != height)) {
    throw Error(fmt::format("{}: the image is {}x{}, but the camera file says {}x{}; correct one",
                            where,
                            width,
                            height,
                            camera.width,
                            camera.height));
  }
  Camera sized = camera;
  sized.width = width;
  sized.height = height;
  centreWhereUnset(sized);
  sized.check();
  return sized;
}

BinBox parseBinBox(const std::string& json_text, const std::string& where) {
  return binBoxFromJson(parseJsonObject(json_text, where), where);
}

BinBox readBinBox(const std::filesystem::path& path) {
  return binBoxFromJson(readJsonFile(path, "bin file"), "bin file " + path.string());
}

}  // namespace rangepose
