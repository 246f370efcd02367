// The random numbers that triples of samples are drawn by.
#pragma once

#include <cstdint>
#include <random>

namespace rangepose {

/// The same in every image, whatever is drawn from.
class PlaneDraws {
 public:
  std::uint64_t next() { return random_(); }

 private:
  std::mt19937_64 random_{20100};
};

}  // namespace rangepose
