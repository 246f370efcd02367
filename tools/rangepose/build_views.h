// The orientations of the views of `rangepose build`: spread evenly, or from pose statistics, which
// are read from a file or simulated.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "geometry/mesh.h"
#include "geometry/symmetry.h"

namespace rangepose::cli {

struct ViewRequest {
  bool adaptive = false;
  int views = 1024;
  int bins = 0;                       ///< to simulate; 0: 500, or as many as a file has
  std::filesystem::path folder;       ///< of the database: where simulated statistics are kept
  std::filesystem::path picture_dir;  ///< for pictures of the statistics; empty: none
};

struct ChosenViews {
  std::vector<glm::dmat3> rotations;  ///< view_from_object
  std::string note;                   ///< where they come from, for the user; may be empty
};

/// Statistics are looked for beside the mesh and beside the database, as NAME.poses; a file of
/// another mesh, or a damaged one, is warned of and not used. If there is none, bins are simulated,
/// with a progress bar, and NAME.poses is written beside the database.
ChosenViews chooseViews(const ViewRequest& request,
                        const std::filesystem::path& mesh_file,
                        const Mesh& mesh,
                        const Symmetries& symmetries);

}  // namespace rangepose::cli
