// Reads the values of a PLY body one after the other, whatever its format.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "io/ply_header.h"

namespace rangepose {

class PlyCursor {
 public:
  PlyCursor(PlyFormat format, std::string_view body, std::string where)
      : format_(format), rest_(body), where_(std::move(where)) {}

  /// The next value; throws Error at the end of the file and, in ASCII, for what is not a number.
  double take(PlyType type);

  /// The next value as the length of a list; throws Error when the rest cannot hold so many.
  int takeListLength(const PlyProperty& property);

  /// Steps over one property, scalar or list.
  void skip(const PlyProperty& property);

 private:
  [[noreturn]] void failTruncated() const;
  double takeBinary(PlyType type);

  PlyFormat format_;
  std::string_view rest_;
  std::string where_;
};

}  // namespace rangepose
