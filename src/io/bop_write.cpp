#include "io/bop_write.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "core/error.h"
#include "io/atomic_file.h"
#include "io/depth_file.h"
#include "io/mesh_file.h"

namespace rangepose {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

Json rows(const glm::dmat3& rotation) {
  Json list = Json::array();
  for (int k = 0; k < 9; ++k) list.push_back(rotation[k % 3][k / 3]);
  return list;
}

Json numbers(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

Json matrix(const Pose& pose) {
  Json list = Json::array();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) list.push_back(pose.rotation[column][row]);
    list.push_back(pose.translation_mm[row]);
  }
  for (const double value : {0.0, 0.0, 0.0, 1.0}) list.push_back(value);
  return list;
}

/// x, y, width, height; BOP writes -1 where there is nothing.
Json box(const PixelBox& pixels) {
  if (pixels.empty()) return {-1, -1, -1, -1};
  return {pixels.x0, pixels.y0, pixels.width(), pixels.height()};
}

Json infoJson(const BopMesh& model) {
  glm::dvec3 low(model.mesh.vertices.at(0));
  glm::dvec3 high = low;
  for (const glm::vec3& vertex : model.mesh.vertices) {
    low = glm::min(low, glm::dvec3(vertex));
    high = glm::max(high, glm::dvec3(vertex));
  }
  Json info{{"diameter", model.info.diameter_mm},
            {"min_x", low.x},
            {"min_y", low.y},
            {"min_z", low.z},
            {"size_x", high.x - low.x},
            {"size_y", high.y - low.y},
            {"size_z", high.z - low.z}};
  for (const Pose& pose : model.info.symmetries_discrete) {
    info["symmetries_discrete"].push_back(matrix(pose));
  }
  for (const BopContinuousSymmetry& axis : model.info.symmetries_continuous) {
    info["symmetries_continuous"].push_back(
        {{"axis", numbers(axis.axis)}, {"offset", numbers(axis.offset_mm)}});
  }
  return info;
}

Json viewCamera(const BopView& view) {
  const Camera& camera = view.image.camera;
  Json json;
  if (camera.orthographic) {
    json = {{"orthographic", true},
            {"pixel_size", camera.pixel_size_mm},
            {"cx", camera.cx},
            {"cy", camera.cy},
            {"width", camera.width},
            {"height", camera.height}};
  } else {
    json["cam_K"] = {camera.fx, 0.0, camera.cx, 0.0, camera.fy, camera.cy, 0.0, 0.0, 1.0};
  }
  json["depth_scale"] = camera.depth_scale;
  json["cam_R_w2c"] = rows(view.camera_from_world.rotation);
  json["cam_t_w2c"] = numbers(view.camera_from_world.translation_mm);
  return json;
}

Json truth(const BopPart& part) {
  return {{"cam_R_m2c", rows(part.camera_from_object.rotation)},
          {"cam_t_m2c", numbers(part.camera_from_object.translation_mm)},
          {"obj_id", part.obj_id}};
}

Json visibility(const BopPart& part) {
  return {{"bbox_obj", box(part.all_box)},
          {"bbox_visib", box(part.visible_box)},
          {"px_count_all", part.all_px},
          {"px_count_valid", part.measured_px},
          {"px_count_visib", part.visible_px},
          {"visib_fract", part.visible_fraction}};
}

Json binJson(const BinBox& bin) {
  return {{"cam_R_bin2c", rows(bin.camera_from_bin.rotation)},
          {"cam_t_bin2c", numbers(bin.camera_from_bin.translation_mm)},
          {"inner_size", numbers(bin.inner_size_mm)}};
}

/// One entry of the outer list or object a line.
void writeLines(const fs::path& path, const Json& json) {
  std::string text;
  for (const auto& [key, entry] : json.items()) {
    text += text.empty() ? "\n" : ",\n";
    text += json.is_object() ? fmt::format("  \"{}\": {}", key, entry.dump()) : "  " + entry.dump();
  }
  const char* const brackets = json.is_object() ? "{}" : "[]";
  writeFileAtomically(path, fmt::format("{}{}\n{}\n", brackets[0], text, brackets[1]));
}

void makeFolder(const fs::path& folder) {
  std::error_code failure;
  fs::create_directories(folder, failure);
  if (failure) {
    throw Error(fmt::format("output folder {}: cannot be made ({}); choose another one",
                            folder.string(),
                            failure.message()));
  }
}

}  // namespace

void writeBopModels(const fs::path& folder, const std::vector<BopMesh>& models) {
  makeFolder(folder);
  Json infos = Json::object();
  int id = 0;
  for (const BopMesh& model : models) {
    ++id;
    writePly(folder / fmt::format("obj_{:06}.ply", id), model.mesh);
    infos[std::to_string(id)] = infoJson(model);
  }
  writeLines(folder / "models_info.json", infos);
}

void writeBopScene(const fs::path& folder, const std::vector<BopView>& views) {
  makeFolder(folder / "depth");
  Json cameras = Json::object();
  Json truths = Json::object();
  Json infos = Json::object();
  Json bins = Json::object();
  for (const BopView& view : views) {
    writeDepthPng(folder / "depth" / fmt::format("{:06}.png", view.im_id), view.image);
    const std::string key = std::to_string(view.im_id);
    cameras[key] = viewCamera(view);
    truths[key] = Json::array();
    infos[key] = Json::array();
    for (const BopPart& part : view.parts) {
      truths[key].push_back(truth(part));
      infos[key].push_back(visibility(part));
    }
    if (view.bin) bins[key] = binJson(*view.bin);
  }
  if (!bins.empty()) writeLines(folder / "scene_bin.json", bins);
  writeLines(folder / "scene_gt_info.json", infos);
  writeLines(folder / "scene_gt.json", truths);
  writeLines(folder / "scene_camera.json", cameras);
}

void writeBopCamera(const fs::path& path, const Camera& camera) {
  Json json;
  if (camera.orthographic) {
    json = {{"orthographic", true}, {"pixel_size", camera.pixel_size_mm}};
  } else {
    json = {{"fx", camera.fx}, {"fy", camera.fy}};
  }
  json["cx"] = camera.cx;
  json["cy"] = camera.cy;
  json["width"] = camera.width;
  json["height"] = camera.height;
  json["depth_scale"] = camera.depth_scale;
  writeFileAtomically(path, json.dump(2) + "\n");
}

std::vector<BopTarget> targetsOf(int scene_id, const BopView& view, double least_visible) {
  std::map<int, int> counts;
  for (const BopPart& part : view.parts) {
    if (part.visible_fraction >= least_visible) ++counts[part.obj_id];
  }
  std::vector<BopTarget> targets;
  targets.reserve(counts.size());
  for (const auto& [obj_id, count] : counts) {
    targets.push_back({scene_id, view.im_id, obj_id, count});
  }
  return targets;
}

void writeBopTargets(const fs::path& path, const std::vector<BopTarget>& targets) {
  Json list = Json::array();
  for (const BopTarget& target : targets) {
    list.push_back({{"im_id", target.im_id},
                    {"inst_count", target.inst_count},
                    {"obj_id", target.obj_id},
                    {"scene_id", target.scene_id}});
  }
  writeLines(path, list);
}

}  // namespace rangepose
