// One formula for one number, as a thread of a GPU computes it, and for eight at a time, as the
// host does: the same operations in the same order, so the same bits.
//
// Such a formula is a template over V, float or Float8. Conditions are masks: both sides of a
// choice are computed, and `pick` takes one.
#pragma once

#include <cmath>
#include <cstring>

#include "core/host_device.h"

#ifdef __CUDACC__
#define RP_LANES __host__ __device__ inline
#else
#include "stages/simd.h"
// So that it becomes part of each clone of its caller.
#define RP_LANES RP_ALWAYS_INLINE
#endif

namespace rangepose {

/// What goes with V: whole numbers and conditions.
template <typename V>
struct LanesOf;

template <>
struct LanesOf<float> {
  using Int = int;
  using Mask = bool;
};

template <typename T>
RP_LANES T pick(bool where, const T& yes, const T& no) {
  return where ? yes : no;
}
RP_LANES bool anyOf(bool mask) { return mask; }
/// Towards 0; the value must fit.
RP_LANES int truncated(float value) { return static_cast<int>(value); }
RP_LANES float asFloat(int value) { return static_cast<float>(value); }
RP_LANES float squareRoot(float value) { return std::sqrt(value); }
RP_LANES float magnitude(float value) { return std::fabs(value); }
/// The numbers must not be NaN: a device has one instruction, and the host a comparison that it can
/// do for eight at a time.
RP_LANES float smaller(float a, float b) {
#ifdef __CUDA_ARCH__
  return fminf(a, b);
#else
  return b < a ? b : a;
#endif
}
RP_LANES float larger(float a, float b) {
#ifdef __CUDA_ARCH__
  return fmaxf(a, b);
#else
  return a < b ? b : a;
#endif
}
RP_LANES bool both(bool a, bool b) { return a && b; }
RP_LANES bool either(bool a, bool b) { return a || b; }

#ifndef __CUDACC__

using Int8 = int __attribute__((vector_size(32)));

template <>
struct LanesOf<Float8> {
  using Int = Int8;
  using Mask = Int8;  ///< all bits of a lane or none
};

RP_LANES Float8 pick(const Int8& where, const Float8& yes, const Float8& no) {
  return where ? yes : no;
}
RP_LANES Int8 pick(const Int8& where, const Int8& yes, const Int8& no) { return where ? yes : no; }
RP_LANES bool anyOf(const Int8& mask) {
  long long parts[4];
  std::memcpy(parts, &mask, sizeof parts);
  return ((parts[0] | parts[1]) | (parts[2] | parts[3])) != 0;
}
RP_LANES Int8 truncated(const Float8& value) { return __builtin_convertvector(value, Int8); }
RP_LANES Float8 asFloat(const Int8& value) { return __builtin_convertvector(value, Float8); }
RP_LANES Float8 squareRoot(const Float8& value) {
  Float8 root;
  for (int i = 0; i < 8; ++i) root[i] = std::sqrt(value[i]);
  return root;
}
RP_LANES Float8 magnitude(const Float8& value) {
  Int8 bits;
  std::memcpy(&bits, &value, sizeof bits);
  bits &= 0x7fffffff;
  Float8 result;
  std::memcpy(&result, &bits, sizeof result);
  return result;
}
RP_LANES Float8 smaller(const Float8& a, const Float8& b) { return b < a ? b : a; }
RP_LANES Int8 both(const Int8& a, const Int8& b) { return a & b; }
RP_LANES Int8 either(const Int8& a, const Int8& b) { return a | b; }

#endif

template <typename V>
RP_LANES V all(float value) {
  return V{} + value;
}

/// Three coordinates.
template <typename V>
struct Lane3 {
  V x;
  V y;
  V z;
};

template <typename V>
RP_LANES V dot(const Lane3<V>& a, const Lane3<V>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

template <typename V>
RP_LANES Lane3<V> cross(const Lane3<V>& a, const Lane3<V>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

template <typename V>
RP_LANES Lane3<V> operator-(const Lane3<V>& a, const Lane3<V>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}

}  // namespace rangepose
