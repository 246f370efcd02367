// Parts that have a size in the image which smells of a wrong unit.
#pragma once

#include <string>
#include <vector>

#include "core/camera.h"
#include "database/reference_database.h"

namespace rangepose {

/// A line for each object that would be less than a dozen pixels wide, or wider than the image, at
/// the median depth. The image must have a measured pixel.
std::vector<std::string> unitWarnings(const DepthImage& depth, const ReferenceDatabase& database);

}  // namespace rangepose
