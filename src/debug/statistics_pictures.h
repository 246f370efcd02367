// Pictures of orientations: how a part comes to lie, and where the views of its database are (paper
// Sect. 4.2, 4.3).
#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "core/glm.h"

namespace rangepose::debug {

/// R = Rz(z) * Ry(y) * Rx(x) [rad]: x and z in -pi..pi, y in -pi/2..pi/2.
glm::dvec3 eulerAngles(const glm::dmat3& rotation);

/// A histogram over each of the three Euler angles of camera_from_object, as the paper draws them.
cv::Mat eulerHistograms(const std::vector<glm::dmat3>& camera_from_object);

/// Azimuth and elevation of the viewing direction in the object's frame, over the whole sphere: the
/// density of the orientations in colours, against that of an even spread, and the views as
/// dots; below it the histogram of the in-plane angle.
cv::Mat sphericalPicture(const std::vector<glm::dmat3>& camera_from_object,
                         const std::vector<glm::dmat3>& views);

/// Both, under a title.
cv::Mat statisticsPage(const std::string& title,
                       const std::string& note,
                       const std::vector<glm::dmat3>& camera_from_object,
                       const std::vector<glm::dmat3>& views);

}  // namespace rangepose::debug
