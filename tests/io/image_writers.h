// Images for the tests, written by the libraries of each format.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace rangepose::test {

/// A PNG with `channels` (1 grey, 3 colour) of `bits`, all samples from `values` in order.
std::string makePng(
    int width, int height, int channels, int bits, const std::vector<std::uint16_t>& values);

struct TiffLayout {
  int channels = 1;
  int bits = 16;
  bool is_float = false;
  bool tiled = false;
  bool compressed = false;
  bool big_endian = false;
};

/// A TIFF; `values` are converted to the sample type.
std::string makeTiff(int width,
                     int height,
                     const TiffLayout& layout,
                     const std::vector<float>& values);

/// An EXR with float channels of these names, all with the same values; half floats if `half`.
std::string makeExr(int width,
                    int height,
                    const std::vector<std::string>& channels,
                    const std::vector<float>& values,
                    bool half = false);

}  // namespace rangepose::test
