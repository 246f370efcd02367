#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <system_error>

#include "core/error.h"
#include "io/bop.h"
#include "io/json_fields.h"
#include "io/text_scan.h"

namespace rangepose {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// NNNNNN of obj_NNNNNN.ply, -1 for other names.
int objectId(const fs::path& path) {
  const std::string stem = path.stem().string();
  if (path.extension() != ".ply" || !stem.starts_with("obj_")) return -1;
  const std::optional<long long> id = parseCount(std::string_view(stem).substr(4));
  return id && *id <= std::numeric_limits<int>::max() ? static_cast<int>(*id) : -1;
}

Pose poseFromMatrix(const std::vector<double>& m, const std::string& where) {
  if (m[12] != 0.0 || m[13] != 0.0 || m[14] != 0.0 || m[15] != 1.0) {
    throw Error(where + " must have 0 0 0 1 as its last row");
  }
  Pose pose;
  pose.rotation = rotationFromRows({m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10]}, where);
  pose.translation_mm = {m[3], m[7], m[11]};
  return pose;
}

const json& optionalArray(const json& object, const char* key, const std::string& where) {
  static const json none = json::array();
  const auto found = object.find(key);
  if (found == object.end()) return none;
  if (!found->is_array()) throw Error(fmt::format("{}: field \"{}\" must be an array", where, key));
  return *found;
}

BopModelInfo modelInfo(const json& object, const std::string& where) {
  if (!object.is_object()) throw Error(where + ": a JSON object {...} is expected");
  BopModelInfo info;
  info.diameter_mm = jsonNumber(object, "diameter", where);
  if (!(info.diameter_mm > 0.0)) throw Error(where + ": field \"diameter\" must be positive");
  for (const json& matrix : optionalArray(object, "symmetries_discrete", where)) {
    const json holder{{"symmetries_discrete", matrix}};
    info.symmetries_discrete.push_back(
        poseFromMatrix(jsonNumbers(holder, "symmetries_discrete", 16, where),
                       where + ": field \"symmetries_discrete\""));
  }
  for (const json& line : optionalArray(object, "symmetries_continuous", where)) {
    if (!line.is_object())
      throw Error(where + ": field \"symmetries_continuous\" must hold objects");
    const std::vector<double> axis = jsonNumbers(line, "axis", 3, where);
    const std::vector<double> offset = jsonNumbers(line, "offset", 3, where);
    const glm::dvec3 direction{axis[0], axis[1], axis[2]};
    if (!(glm::length(direction) > 0.0)) throw Error(where + ": field \"axis\" must not be zero");
    info.symmetries_continuous.push_back(
        {glm::normalize(direction), {offset[0], offset[1], offset[2]}});
  }
  return info;
}

}  // namespace

std::vector<BopModel> readBopModels(const fs::path& folder) {
  std::vector<BopModel> models;
  std::error_code failure;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, failure)) {
    const int id = objectId(entry.path());
    if (id >= 0) models.push_back({id, entry.path(), std::nullopt});
  }
  if (failure) {
    throw Error(fmt::format("folder {}: cannot be read ({})", folder.string(), failure.message()));
  }
  std::sort(models.begin(), models.end(), [](const BopModel& a, const BopModel& b) {
    return a.obj_id < b.obj_id;
  });
  const fs::path info_path = folder / "models_info.json";
  if (!fs::exists(info_path, failure)) return models;
  const json infos = readJsonFile(info_path, "model list");
  for (BopModel& model : models) {
    const std::string key = std::to_string(model.obj_id);
    const auto found = infos.find(key);
    if (found == infos.end()) continue;
    model.info =
        modelInfo(*found, fmt::format("model list {}: object {}", info_path.string(), key));
  }
  return models;
}

}  // namespace rangepose
