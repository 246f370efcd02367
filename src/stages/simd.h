// Eight floats at a time, and code compiled for more than one processor.
#pragma once

#include <cstring>

// Vectors are only ever passed between inlined functions: no ABI is involved, and no code for AVX
// leaves the upper halves of registers in use, which would slow down all SSE code to come.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wpsabi"
#endif
#define RP_ALWAYS_INLINE inline __attribute__((always_inline))

namespace rangepose {

/// GCC and Clang turn this into one AVX register or two SSE or NEON ones; the arithmetic, and with
/// it every result, is the same.
using Float8 = float __attribute__((vector_size(32)));
inline constexpr int kLanes = 8;

RP_ALWAYS_INLINE Float8 load8(const float* from) {
  Float8 value;
  std::memcpy(&value, from, sizeof value);
  return value;
}

RP_ALWAYS_INLINE void store8(float* to, const Float8& value) {
  std::memcpy(to, &value, sizeof value);
}

RP_ALWAYS_INLINE Float8 splat8(float value) { return Float8{} + value; }

/// Sum in a fixed order: pairs at distance 4, 2, 1.
template <typename Eight>
RP_ALWAYS_INLINE auto sum8(const Eight& v) {
  return ((v[0] + v[4]) + (v[2] + v[6])) + ((v[1] + v[5]) + (v[3] + v[7]));
}

/// Of all numbers of a struct of nothing but Float8, as the same struct of floats.
template <template <typename> typename Numbers>
RP_ALWAYS_INLINE Numbers<float> sumOfLanes(const Numbers<Float8>& lanes) {
  constexpr int kNumbers = static_cast<int>(sizeof(Numbers<float>) / sizeof(float));
  Float8 from[kNumbers];
  static_assert(sizeof from == sizeof lanes);
  std::memcpy(from, &lanes, sizeof from);
  float to[kNumbers];
  for (int i = 0; i < kNumbers; ++i) to[i] = sum8(from[i]);
  Numbers<float> sums;
  std::memcpy(&sums, to, sizeof sums);
  return sums;
}

}  // namespace rangepose

// Sanitizers start later than the resolvers of cloned functions run.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define RP_SIMD_CLONES __attribute__((target_clones("avx2", "default")))
#else
#define RP_SIMD_CLONES
#endif
