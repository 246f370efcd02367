// Plots of the search: how the error (paper Eq. 1) is spread over the views.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "stages/reference.h"
#include "stages/search.h"

namespace rangepose::debug {

/// Errors in ascending order, a curve a window, with best view and median in the legend. Views that
/// could not be compared (kWorstError) are counted, not drawn.
cv::Mat sortedErrorPlot(const std::vector<Hypothesis>& hypotheses);

/// Best error over azimuth and elevation of the viewing direction, in the object's frame (the third
/// row of view_from_object). In-plane rotations, and directions nearer than a few degrees, share a
/// cell, which takes the lowest error; the best view is circled.
cv::Mat errorOverDirections(const ReferenceObject& object,
                            const std::vector<Hypothesis>& hypotheses);

}  // namespace rangepose::debug
