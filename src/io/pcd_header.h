// The header of a PCD file, version 0.7.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace rangepose {

struct PcdField {
  std::string name;
  char type = 'F';
  long long size = 4;      ///< bytes of one value: 1, 2, 4 or 8
  long long count = 1;     ///< values
  std::size_t offset = 0;  ///< of its first byte within a point

  std::size_t bytes() const { return static_cast<std::size_t>(size * count); }
};

struct PcdHeader {
  std::vector<PcdField> fields;
  std::array<std::size_t, 3> axes{};  ///< indices of the fields x, y, z
  std::size_t point_bytes = 0;
  long long width = 0;    ///< > 0
  long long height = 0;   ///< > 0
  long long points = -1;  ///< width * height
  std::string data;       ///< ascii, binary or binary_compressed

  const PcdField& axis(std::size_t index) const { return fields[axes[index]]; }
};

/// Takes the header off the front of `rest`, up to the data. Throws Error naming `where`: the
/// fields x, y and z are there, each one float or double, and the counts agree with each other and
/// are not absurd.
PcdHeader takePcdHeader(std::string_view& rest, const std::string& where);

}  // namespace rangepose
