// Data sets in the BOP layout: reading them, and the CSV of results.
//
//   DIR/models/obj_NNNNNN.ply, models_info.json
//   DIR/<split>/NNNNNN/depth/NNNNNN.png|tif|exr, scene_camera.json, scene_bin.json (not of BOP,
//   optional) DIR/test_targets_bop19.json
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/camera.h"
#include "core/pose.h"

namespace rangepose {

/// Rotation by any angle about a line.
struct BopContinuousSymmetry {
  glm::dvec3 axis{0.0, 0.0, 1.0};  ///< unit vector
  glm::dvec3 offset_mm{0.0};       ///< a point of the line
};

/// An entry of models_info.json.
struct BopModelInfo {
  double diameter_mm = 0.0;
  std::vector<Pose> symmetries_discrete;  ///< without the identity
  std::vector<BopContinuousSymmetry> symmetries_continuous;
};

struct BopModel {
  int obj_id = 0;
  std::filesystem::path mesh_path;
  std::optional<BopModelInfo> info;  ///< where models_info.json has it
};

/// An entry of test_targets_bop19.json.
struct BopTarget {
  int scene_id = 0;
  int im_id = 0;
  int obj_id = 0;
  int inst_count = 1;
};

struct BopImage {
  int im_id = 0;
  std::filesystem::path depth_path;
  Camera camera;                   ///< width and height 0: readDepth() takes them from the image
  std::optional<BinBox> bin;       ///< of scene_bin.json
  std::vector<BopTarget> targets;  ///< of this image, where the data set has a list of targets
};

struct BopScene {
  int scene_id = 0;
  std::filesystem::path folder;
  std::vector<BopImage> images;  ///< by id
};

struct BopDataset {
  std::filesystem::path folder;
  std::vector<BopModel> models;    ///< by id; empty where there is no folder of models
  std::vector<BopScene> scenes;    ///< by id; empty where the split is not there
  std::vector<BopTarget> targets;  ///< as in the file
};

/// `dir` is the data set, or a folder of scenes (then models lie in it or beside it). With a list
/// of targets and the split "test" only images of the list are kept. Images without a depth file
/// are left out, unless the list names them. Throws Error when there are neither models nor scenes,
/// and for damaged files.
BopDataset openBop(const std::filesystem::path& dir, const std::string& split = "test");

/// Of all its scenes.
int imageCount(const BopDataset& dataset);

/// obj_NNNNNN.ply of a folder with the entries of its models_info.json, by id.
std::vector<BopModel> readBopModels(const std::filesystem::path& folder);

/// One row of a result file.
struct BopEstimate {
  int scene_id = 0;
  int im_id = 0;
  int obj_id = 0;
  double score = 0.0;       ///< higher is surer
  Pose camera_from_object;  ///< [mm]
  double time_s = -1.0;     ///< for the whole image, equal in all its rows; -1 when not measured
};

/// The text of a result file: scene_id,im_id,obj_id,score,R,t,time with R row by row and t in mm.
/// Throws Error for values that are not finite, and for rows of one image with different times.
std::string bopCsv(const std::vector<BopEstimate>& estimates);

/// Writes bopCsv(), whole or not at all.
void writeBopCsv(const std::filesystem::path& path, const std::vector<BopEstimate>& estimates);

/// Reads such a file, by anybody. Throws Error, naming the line, for a row that is damaged, and for
/// rows of one image with different times.
std::vector<BopEstimate> readBopCsv(const std::filesystem::path& path);

}  // namespace rangepose
