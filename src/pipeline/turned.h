// Other poses that would show nearly the same: what the search finds for a part that is partly
// hidden may be turned the wrong way.
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/surface_sample.h"
#include "pipeline/refine.h"

namespace rangepose {

/// The pose turned about the principal axes of what it explains of the depth image, `pixels` by
/// index: by eighths of a turn about the longest, by quarters about the others. A pipe turned about
/// its own axis, or end for end, still covers what is seen of it. Also by half turns about the
/// principal axes of the part, `own`: many parts are the same again but for a pocket. To be aligned
/// anew.
std::vector<Candidate> turnedCopies(const Candidate& candidate,
                                    const std::vector<std::int32_t>& pixels,
                                    const DepthImage& depth,
                                    const ReferenceObject& object,
                                    const AreaMoments& own);

}  // namespace rangepose
