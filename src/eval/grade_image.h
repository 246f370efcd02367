// All errors between the estimates and the true poses of one object in one image.
#pragma once

#include <vector>

#include "core/camera.h"
#include "eval/matching.h"
#include "eval/pose_errors.h"
#include "eval/vsd.h"

namespace rangepose {

struct ImageGrading {
  std::vector<Pose> estimates;  ///< camera_from_object, by falling score
  std::vector<Pose> truths;     ///< camera_from_object
  ObjectErrors errors;          ///< its tables are filled by fillErrors()
};

/// `measured_mm` is distancesOf() the depth image.
void fillErrors(ImageGrading& grading,
                const ErrorModel& model,
                const Camera& camera,
                const Image<float>& measured_mm,
                const VsdOptions& vsd);

}  // namespace rangepose
