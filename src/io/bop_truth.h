// True poses of the images of a scene in the BOP layout: scene_gt.json, scene_gt_info.json.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <vector>

#include "core/pose.h"

namespace rangepose {

struct BopTruth {
  int obj_id = 0;
  Pose camera_from_object;                 ///< [mm]
  std::optional<double> visible_fraction;  ///< 0..1; empty where scene_gt_info.json does not say
};

/// By image id, in the order of the file. Throws Error when scene_gt.json is missing or damaged, or
/// scene_gt_info.json does not fit it; the latter may be missing.
std::map<int, std::vector<BopTruth>> readBopTruth(const std::filesystem::path& scene_folder);

/// One file in the format of scene_gt.json; visible fractions are not known. Throws Error when it
/// is missing or damaged.
std::map<int, std::vector<BopTruth>> readBopTruthFile(const std::filesystem::path& path);

}  // namespace rangepose
