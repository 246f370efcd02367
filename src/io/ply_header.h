// The header of a PLY file.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace rangepose {

enum class PlyFormat { kAscii, kLittleEndian, kBigEndian };
enum class PlyType { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat32, kFloat64 };

/// Bytes of a value in a binary file.
std::size_t plyTypeBytes(PlyType type);

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::kFloat32;
  bool is_list = false;
  PlyType count_type = PlyType::kUint8;  ///< of a list
};

struct PlyElement {
  std::string name;
  std::int64_t count = 0;
  std::vector<PlyProperty> properties;

  /// Index of a property, -1 where there is none.
  int indexOf(std::string_view property) const;
};

struct PlyHeader {
  PlyFormat format = PlyFormat::kAscii;
  std::vector<PlyElement> elements;
  std::int64_t grid_columns = 0;  ///< num_cols of obj_info or comment, 0 where there is none
  std::int64_t grid_rows = 0;     ///< num_rows, likewise
  std::string_view body;          ///< the bytes after the header
};

/// Throws Error for anything that is not a PLY header, and for an element of which the body is too
/// short to hold the count that is promised: memory can be taken by the counts afterwards.
PlyHeader parsePlyHeader(std::string_view bytes, const std::string& where);

}  // namespace rangepose
