#include "io/bop.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <system_error>
#include <utility>

#include "core/error.h"
#include "io/json_fields.h"
#include "io/text_scan.h"

namespace rangepose {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr int kMaxId = std::numeric_limits<int>::max();

/// Targets of each image, by (scene id, image id).
using TargetMap = std::map<std::pair<int, int>, std::vector<BopTarget>>;

bool isFolder(const fs::path& path) {
  std::error_code failure;
  return fs::is_directory(path, failure);
}

bool isThere(const fs::path& path) {
  std::error_code failure;
  return fs::exists(path, failure);
}

/// The number that a name of digits is, -1 for other names.
int idOf(const std::string& name) {
  const bool digits = !name.empty() && name.find_first_not_of("0123456789") == std::string::npos;
  const std::optional<long long> id = digits ? parseCount(name) : std::nullopt;
  return id && *id <= kMaxId ? static_cast<int>(*id) : -1;
}

/// Numbered folders with a scene_camera.json, by id.
std::vector<BopScene> findScenes(const fs::path& folder) {
  std::vector<BopScene> scenes;
  std::error_code failure;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, failure)) {
    const int id = idOf(entry.path().filename().string());
    if (id >= 0 && isThere(entry.path() / "scene_camera.json")) {
      scenes.push_back({id, entry.path(), {}});
    }
  }
  std::sort(scenes.begin(), scenes.end(), [](const BopScene& a, const BopScene& b) {
    return a.scene_id < b.scene_id;
  });
  return scenes;
}

std::vector<BopTarget> readTargets(const fs::path& path) {
  std::vector<BopTarget> targets;
  const json list = readJsonFile(path, "target list", true);
  for (const json& entry : list) {
    const std::string where =
        fmt::format("target list {}: entry {}", path.string(), targets.size());
    if (!entry.is_object()) throw Error(where + " must be an object");
    BopTarget target;
    target.scene_id = jsonInteger(entry, "scene_id", 0, kMaxId, where);
    target.im_id = jsonInteger(entry, "im_id", 0, kMaxId, where);
    target.obj_id = jsonInteger(entry, "obj_id", 0, kMaxId, where);
    if (entry.contains("inst_count")) {
      target.inst_count = jsonInteger(entry, "inst_count", 0, kMaxId, where);
    }
    targets.push_back(target);
  }
  return targets;
}

/// The depth file of an image; empty where there is none.
fs::path findDepth(const fs::path& scene, int im_id) {
  for (const char* extension : {"png", "tif", "tiff", "exr"}) {
    fs::path path = scene / "depth" / fmt::format("{:06}.{}", im_id, extension);
    if (isThere(path)) return path;
  }
  return {};
}

void readImages(BopScene& scene, const TargetMap* targets) {
  const fs::path camera_path = scene.folder / "scene_camera.json";
  const fs::path bin_path = scene.folder / "scene_bin.json";
  const json cameras = readJsonFile(camera_path, "camera list");
  const json bins = isThere(bin_path) ? readJsonFile(bin_path, "bin list") : json::object();
  for (const auto& [key, entry] : cameras.items()) {
    BopImage image;
    image.im_id = idOf(key);
    if (image.im_id < 0) {
      throw Error(fmt::format("camera list {}: an image id is no number", camera_path.string()));
    }
    if (targets != nullptr) {
      const auto listed = targets->find({scene.scene_id, image.im_id});
      if (listed == targets->end()) continue;
      image.targets = listed->second;
    }
    image.depth_path = findDepth(scene.folder, image.im_id);
    if (image.depth_path.empty()) {
      if (targets == nullptr) continue;
      throw Error(fmt::format("scene {}: no depth image for image {}, which the target list names",
                              scene.folder.string(),
                              image.im_id));
    }
    image.camera =
        cameraFromJson(entry, fmt::format("camera list {}: image {}", camera_path.string(), key));
    if (const auto bin = bins.find(key); bin != bins.end()) {
      image.bin =
          binBoxFromJson(*bin, fmt::format("bin list {}: image {}", bin_path.string(), key));
    }
    scene.images.push_back(std::move(image));
  }
  std::sort(scene.images.begin(), scene.images.end(), [](const BopImage& a, const BopImage& b) {
    return a.im_id < b.im_id;
  });
}

fs::path findModels(const fs::path& dir) {
  for (const char* name : {"models", "models_eval", "models_cad"}) {
    if (isFolder(dir / name)) return dir / name;
  }
  return {};
}

}  // namespace

int imageCount(const BopDataset& dataset) {
  std::size_t count = 0;
  for (const BopScene& scene : dataset.scenes) count += scene.images.size();
  return static_cast<int>(count);
}

BopDataset openBop(const fs::path& dir, const std::string& split) {
  if (!isFolder(dir)) throw Error(fmt::format("BOP data {}: no such folder", dir.string()));
  BopDataset dataset;
  dataset.folder = dir;
  dataset.scenes = findScenes(dir / split);
  fs::path models = findModels(dir);
  if (dataset.scenes.empty()) {
    dataset.scenes = findScenes(dir);
    if (models.empty() && !dataset.scenes.empty()) models = findModels(dir / "..");
  }
  if (!models.empty()) dataset.models = readBopModels(models);

  const fs::path target_path = dir / "test_targets_bop19.json";
  TargetMap targets;
  const bool listed = split == "test" && isThere(target_path);
  if (listed) {
    dataset.targets = readTargets(target_path);
    for (const BopTarget& target : dataset.targets) {
      targets[{target.scene_id, target.im_id}].push_back(target);
    }
  }
  for (BopScene& scene : dataset.scenes) readImages(scene, listed ? &targets : nullptr);
  if (imageCount(dataset) == 0 && dataset.models.empty()) {
    throw Error(
        fmt::format("BOP data {}: neither models/obj_*.ply nor depth images in {}/NNNNNN; "
                    "check folder and split",
                    dir.string(),
                    split));
  }
  return dataset;
}

}  // namespace rangepose
