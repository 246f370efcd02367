#include "io/lzf.h"

#include <cstdint>

#include "core/error.h"

namespace rangepose {

// A stream of two kinds of pieces, told by the control byte that opens each:
//   000nnnnn  n + 1 bytes follow as they are
//   nnnddddd  a copy of n + 2 bytes from (ddddd << 8 | next byte) + 1 bytes back; n = 7 means that
//   another
//             byte, which comes before the distance byte, is added to n
std::string expandLzf(std::string_view packed, std::size_t size, const std::string& where) {
  const auto fail = [&]() -> void {
    throw Error(where + ": the compressed data is damaged or truncated; write it again");
  };
  std::string expanded;
  expanded.reserve(size);
  std::size_t at = 0;
  const auto next = [&]() -> std::size_t {
    if (at >= packed.size()) fail();
    return static_cast<unsigned char>(packed[at++]);
  };
  while (at < packed.size()) {
    const std::size_t control = next();
    if (control < 32) {
      const std::size_t count = control + 1;
      if (count > packed.size() - at || count > size - expanded.size()) fail();
      expanded.append(packed.substr(at, count));
      at += count;
      continue;
    }
    std::size_t count = control >> 5;
    if (count == 7) count += next();
    count += 2;
    const std::size_t distance = ((control & 31) << 8 | next()) + 1;
    if (distance > expanded.size() || count > size - expanded.size()) fail();
    // Byte by byte: source and target overlap where the distance is shorter than the copy.
    for (std::size_t i = 0; i < count; ++i)
      expanded.push_back(expanded[expanded.size() - distance]);
  }
  if (expanded.size() != size) fail();
  return expanded;
}

}  // namespace rangepose
