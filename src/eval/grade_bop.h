// A result file measured against the truth of a data set in the BOP layout.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "eval/matching.h"
#include "eval/vsd.h"
#include "geometry/symmetry.h"
#include "io/bop.h"

namespace rangepose {

struct GradedObject {
  int obj_id = 0;
  std::string name;  ///< of the mesh
  double diameter_mm = 0.0;
  std::size_t symmetric_poses = 1;  ///< that count as the same, turns of a solid in steps
};

struct GradedResults {
  std::vector<GradedObject> objects;  ///< those of truth or results, by id
  std::vector<ObjectErrors> images;   ///< by scene, image, object; those with a part or an estimate
  int image_count = 0;
  double mean_time_s = 0.0;           ///< of the images with a measured time; NaN without one
  std::vector<std::string> warnings;  ///< one line each
};

/// The symmetries that models_info.json gives.
Symmetries symmetriesOf(const BopModelInfo& info);

/// Throws Error when there is no truth, or a row names an image or an object that the data set does
/// not have. `progress(done, total)`, which may be empty, is called by one thread at a time.
///
/// Symmetries are those of models_info.json where it has the object, else found in the mesh. Meshes
/// come from models_eval where that folder exists, as BOP asks for.
GradedResults gradeBop(const BopDataset& data,
                       const std::vector<BopEstimate>& rows,
                       const VsdOptions& vsd = {},
                       const std::function<void(int done, int total)>& progress = {});

}  // namespace rangepose
