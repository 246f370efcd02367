// Inputs that do not fit together: wrong units, a bin box that is somewhere else.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/camera.h"
#include "database/reference_database.h"

namespace rangepose {

/// A line for each object that would be less than a dozen pixels wide, or wider than the image, at
/// the median depth. The image must have a measured pixel.
std::vector<std::string> unitWarnings(const DepthImage& depth, const ReferenceDatabase& database);

/// A line where nothing that was measured lies in the bin, or where much that lies between its
/// walls is under its floor: no part is found there.
std::vector<std::string> binWarnings(const DepthImage& depth,
                                     const BinBox& bin,
                                     const ReferenceDatabase& database);

}  // namespace rangepose
