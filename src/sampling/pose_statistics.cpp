#include "sampling/pose_statistics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <numbers>

#include "core/byte_stream.h"
#include "core/pose.h"

namespace rangepose {
namespace {

constexpr FileKind kStatistics = {
    {'R', 'P', 'P', 'S'}, 1, "pose statistics file", "simulate again by --sampling adaptive"};

using Quaternion = std::array<double, 4>;  // x, y, z, w

/// A rotation in six bytes: the three smaller components of its quaternion in 15 bits each, and in
/// the top bits of the first two which one is missing.
using Packed = std::array<std::uint16_t, 3>;
constexpr double kScale = 16383.0 * std::numbers::sqrt2;  // smaller ones are within +-1/sqrt(2)
constexpr double kMiddle = 16383.0;

Packed pack(const glm::dmat3& rotation) {
  const auto [w, x, y, z] = quaternionOf(rotation);
  const Quaternion q = {x, y, z, w};
  const auto largest = std::max_element(
      q.begin(), q.end(), [](double a, double b) { return std::abs(a) < std::abs(b); });
  const double sign = *largest < 0.0 ? -1.0 : 1.0;
  const std::size_t missing = static_cast<std::size_t>(largest - q.begin());
  Packed packed{};
  std::size_t next = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    if (i == missing) continue;
    const double step = std::clamp(std::round(sign * q[i] * kScale) + kMiddle, 0.0, 2 * kMiddle);
    packed[next++] = static_cast<std::uint16_t>(step);
  }
  packed[0] = static_cast<std::uint16_t>(packed[0] | ((missing & 1U) << 15U));
  packed[1] = static_cast<std::uint16_t>(packed[1] | ((missing >> 1U) << 15U));
  return packed;
}

glm::dmat3 unpack(const Packed& packed) {
  const std::size_t missing = (packed[0] >> 15U) + 2U * (packed[1] >> 15U);
  Quaternion q{};
  double squares = 0.0;
  std::size_t next = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    if (i == missing) continue;
    q[i] = ((packed[next++] & 0x7fffU) - kMiddle) / kScale;
    squares += q[i] * q[i];
  }
  q[missing] = std::sqrt(std::max(0.0, 1.0 - squares));
  double length = 0.0;
  for (const double value : q) length += value * value;
  for (double& value : q) value /= std::sqrt(length);
  return rotationFromQuaternion(q[0], q[1], q[2], q[3]);
}

}  // namespace

std::vector<char> serialize(const PoseStatistics& statistics) {
  RP_CHECK(statistics.rotations.size() <= kMostKeptRotations,
           "pose statistics: too many orientations for a file");
  ByteWriter payload;
  payload.value(statistics.mesh_hash);
  payload.value(statistics.seed);
  payload.value(statistics.bins);
  payload.value(statistics.parts);
  payload.value(static_cast<std::uint64_t>(statistics.rotations.size()));
  for (const glm::dmat3& rotation : statistics.rotations) payload.value(pack(rotation));
  return framed(kStatistics, payload.take());
}

PoseStatistics deserializeStatistics(const std::vector<char>& bytes, const std::string& where) {
  ByteReader in = payloadOf(kStatistics, bytes, where);
  PoseStatistics statistics;
  statistics.mesh_hash = in.value<std::uint64_t>();
  statistics.seed = in.value<std::uint64_t>();
  statistics.bins = in.value<std::int32_t>();
  statistics.parts = in.value<std::int32_t>();
  const std::size_t count = in.count(sizeof(Packed));
  if (count == 0 || count > kMostKeptRotations) in.fail("impossible number of orientations");
  if (statistics.bins < 1 || static_cast<std::size_t>(std::max(0, statistics.parts)) < count) {
    in.fail("impossible number of bins or parts");
  }
  for (std::size_t i = 0; i < count; ++i)
    statistics.rotations.push_back(unpack(in.value<Packed>()));
  if (in.left() != 0) in.fail("bytes after the last orientation");
  return statistics;
}

PoseStatistics readStatistics(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  if (!file || std::filesystem::is_directory(path)) {
    throw Error(path.string() + ": cannot open the pose statistics");
  }
  const std::streamoff size = file.tellg();
  std::vector<char> bytes(size > 0 ? static_cast<std::size_t>(size) : 0);
  file.seekg(0);
  file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (!file) throw Error(path.string() + ": cannot read the pose statistics");
  return deserializeStatistics(bytes, path.string());
}

}  // namespace rangepose
