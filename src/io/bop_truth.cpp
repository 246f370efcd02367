#include "io/bop_truth.h"

#include <fmt/format.h>

#include <limits>
#include <string>
#include <system_error>

#include "core/error.h"
#include "io/json_fields.h"
#include "io/text_scan.h"

namespace rangepose {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr int kMaxId = std::numeric_limits<int>::max();

int imageId(const std::string& key, const fs::path& path) {
  const std::optional<long long> id = parseCount(key);
  if (id && *id <= kMaxId) return static_cast<int>(*id);
  throw Error(fmt::format("truth {}: an image id is no number", path.string()));
}

const json& list(const json& entry, const std::string& where) {
  if (!entry.is_array()) throw Error(where + ": an array [...] of objects is expected");
  for (const json& item : entry) {
    if (!item.is_object()) throw Error(where + ": an array [...] of objects is expected");
  }
  return entry;
}

std::vector<BopTruth> truthsOf(const json& entry, const std::string& where) {
  std::vector<BopTruth> truths;
  for (const json& item : list(entry, where)) {
    const std::string which = fmt::format("{}, part {}", where, truths.size());
    BopTruth truth;
    truth.obj_id = jsonInteger(item, "obj_id", 0, kMaxId, which);
    truth.camera_from_object.rotation =
        rotationFromRows(jsonNumbers(item, "cam_R_m2c", 9, which), which + ": field \"cam_R_m2c\"");
    const std::vector<double> t = jsonNumbers(item, "cam_t_m2c", 3, which);
    truth.camera_from_object.translation_mm = {t[0], t[1], t[2]};
    truths.push_back(truth);
  }
  return truths;
}

void addVisibility(const fs::path& path, std::map<int, std::vector<BopTruth>>& images) {
  const json infos = readJsonFile(path, "visibility list");
  for (auto& [id, truths] : images) {
    const std::string where = fmt::format("visibility list {}: image {}", path.string(), id);
    const auto found = infos.find(std::to_string(id));
    if (found == infos.end()) throw Error(where + " is missing; scene_gt.json has it");
    const json& entries = list(*found, where);
    if (entries.size() != truths.size()) {
      throw Error(fmt::format(
          "{} has {} parts, scene_gt.json has {}", where, entries.size(), truths.size()));
    }
    for (std::size_t i = 0; i < truths.size(); ++i) {
      const double visible = jsonNumber(entries[i], "visib_fract", where);
      if (!(visible >= 0.0 && visible <= 1.0 + 1e-6)) {
        throw Error(where + ": field \"visib_fract\" must lie in 0..1");
      }
      truths[i].visible_fraction = visible;
    }
  }
}

}  // namespace

std::map<int, std::vector<BopTruth>> readBopTruthFile(const fs::path& path) {
  std::map<int, std::vector<BopTruth>> images;
  const json entries = readJsonFile(path, "truth");
  for (const auto& [key, entry] : entries.items()) {
    images[imageId(key, path)] =
        truthsOf(entry, fmt::format("truth {}: image {}", path.string(), key));
  }
  return images;
}

std::map<int, std::vector<BopTruth>> readBopTruth(const fs::path& scene_folder) {
  std::map<int, std::vector<BopTruth>> images = readBopTruthFile(scene_folder / "scene_gt.json");
  const fs::path info_path = scene_folder / "scene_gt_info.json";
  std::error_code failure;
  if (fs::exists(info_path, failure)) addVisibility(info_path, images);
  return images;
}

}  // namespace rangepose
