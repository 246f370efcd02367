// Data sets in the BOP layout: writing them. What openBop() and readBopTruth() read, and no more
// than BOP knows but for scene_bin.json.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "core/camera.h"
#include "core/image.h"
#include "core/pose.h"
#include "geometry/mesh.h"
#include "io/bop.h"

namespace rangepose {

/// A part in an image.
struct BopPart {
  int obj_id = 0;
  Pose camera_from_object;        ///< [mm]
  double visible_fraction = 0.0;  ///< 0..1, of the silhouette
  int all_px = 0;                 ///< of the silhouette, also beyond the image
  int measured_px = 0;            ///< of the silhouette that have a depth
  int visible_px = 0;             ///< that show the part
  PixelBox all_box;               ///< of the silhouette, may reach beyond the image
  PixelBox visible_box;           ///< of what is seen
};

struct BopView {
  int im_id = 0;
  DepthImage image;
  Pose camera_from_world;
  std::optional<BinBox> bin;
  std::vector<BopPart> parts;
};

struct BopMesh {
  Mesh mesh;
  BopModelInfo info;
};

/// obj_NNNNNN.ply with ids 1, 2, ... and models_info.json.
void writeBopModels(const std::filesystem::path& folder, const std::vector<BopMesh>& models);

/// depth/NNNNNN.png of all images, then scene_bin.json, scene_gt_info.json, scene_gt.json, and at
/// last scene_camera.json: without it the folder is no scene, so that one that was interrupted is
/// not taken for whole.
void writeBopScene(const std::filesystem::path& folder, const std::vector<BopView>& views);

/// camera.json of the data set.
void writeBopCamera(const std::filesystem::path& path, const Camera& camera);

/// Parts of a view that an estimate should find, counted by object: those that are visible by
/// `least_visible` of their silhouette.
std::vector<BopTarget> targetsOf(int scene_id, const BopView& view, double least_visible = 0.1);

/// test_targets_bop19.json.
void writeBopTargets(const std::filesystem::path& path, const std::vector<BopTarget>& targets);

}  // namespace rangepose
