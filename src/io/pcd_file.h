// Points of PCD files, version 0.7.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/glm.h"

namespace rangepose {

struct PcdPoints {
  std::vector<glm::dvec3> points;  ///< in the unit of the file; may be NaN
  int width = 0;                   ///< width * height == points.size()
  int height = 0;
};

/// True for a text that begins like a PCD header.
bool looksLikePcd(std::string_view bytes);

/// Throws Error naming `where`; counts are checked against the size of the data before memory is
/// taken.
PcdPoints parsePcd(std::string_view bytes, const std::string& where);

}  // namespace rangepose
