// How deep points lie inside of a closed mesh, from its faces alone: nothing of the pieces or of
// the engine that the drop works with.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "core/pose.h"
#include "geometry/mesh.h"
#include "sim/random.h"

namespace rangepose::test {

inline double distanceToSegment(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b) {
  const double share = glm::dot(p - a, b - a) / glm::dot(b - a, b - a);
  return glm::distance(p, a + std::clamp(share, 0.0, 1.0) * (b - a));
}

inline double distanceToTriangle(const glm::dvec3& p,
                                 const glm::dvec3& a,
                                 const glm::dvec3& b,
                                 const glm::dvec3& c) {
  const glm::dvec3 normal = glm::normalize(glm::cross(b - a, c - a));
  const auto isLeft = [&](const glm::dvec3& from, const glm::dvec3& to) {
    return glm::dot(glm::cross(to - from, p - from), normal) >= 0.0;
  };
  if (isLeft(a, b) && isLeft(b, c) && isLeft(c, a)) return std::abs(glm::dot(p - a, normal));
  return std::min(
      {distanceToSegment(p, a, b), distanceToSegment(p, b, c), distanceToSegment(p, c, a)});
}

/// Faces are sorted into columns along z, so that a ray along z meets few.
class DepthOracle {
 public:
  explicit DepthOracle(const Mesh& mesh) {
    for (const glm::uvec3& t : mesh.triangles) {
      faces_.push_back({glm::dvec3(mesh.vertices[t.x]),
                        glm::dvec3(mesh.vertices[t.y]),
                        glm::dvec3(mesh.vertices[t.z])});
    }
    for (const glm::vec3& v : mesh.vertices) {
      low_ = glm::min(low_, glm::dvec3(v));
      high_ = glm::max(high_, glm::dvec3(v));
    }
    columns_.resize(static_cast<std::size_t>(kColumns) * kColumns);
    for (std::size_t k = 0; k < faces_.size(); ++k) addToColumns(k);
  }

  /// Distance of a point inside to the surface [mm]; 0 outside.
  double depth(const glm::dvec3& point) const {
    if (!isInside(point)) return 0.0;
    double nearest = std::numeric_limits<double>::max();
    for (const auto& [a, b, c] : faces_) {
      nearest = std::min(nearest, distanceToTriangle(point, a, b, c));
    }
    return nearest;
  }

  bool isInside(const glm::dvec3& point) const {
    for (int axis = 0; axis < 3; ++axis) {
      if (point[axis] <= low_[axis] || point[axis] >= high_[axis]) return false;
    }
    // Off the vertices and edges of tidy meshes.
    const glm::dvec2 p = glm::dvec2(point) + glm::dvec2(1.37e-6, 2.11e-6);
    int above = 0;
    for (const std::size_t k : columns_[column(cell(p.x, 0), cell(p.y, 1))]) {
      above += crossesAbove(faces_[k], p, point.z) ? 1 : 0;
    }
    return above % 2 == 1;
  }

 private:
  static constexpr int kColumns = 48;
  using Face = std::array<glm::dvec3, 3>;

  static std::size_t column(int x, int y) {
    return static_cast<std::size_t>(y) * kColumns + static_cast<std::size_t>(x);
  }
  int cell(double value, int axis) const {
    const double share = (value - low_[axis]) / (high_[axis] - low_[axis]);
    return std::clamp(static_cast<int>(share * kColumns), 0, kColumns - 1);
  }
  void addToColumns(std::size_t k) {
    const auto& [a, b, c] = faces_[k];
    const glm::dvec3 low = glm::min(a, glm::min(b, c)) - 1e-4;
    const glm::dvec3 high = glm::max(a, glm::max(b, c)) + 1e-4;
    for (int y = cell(low.y, 1); y <= cell(high.y, 1); ++y) {
      for (int x = cell(low.x, 0); x <= cell(high.x, 0); ++x) columns_[column(x, y)].push_back(k);
    }
  }
  static bool crossesAbove(const Face& face, const glm::dvec2& p, double z) {
    const auto side = [&p](const glm::dvec3& a, const glm::dvec3& b) {
      return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
    };
    const double u = side(face[1], face[2]);
    const double v = side(face[2], face[0]);
    const double w = side(face[0], face[1]);
    const bool inside = (u > 0.0 && v > 0.0 && w > 0.0) || (u < 0.0 && v < 0.0 && w < 0.0);
    return inside && (u * face[0].z + v * face[1].z + w * face[2].z) / (u + v + w) > z;
  }

  std::vector<Face> faces_;
  std::vector<std::vector<std::size_t>> columns_;
  glm::dvec3 low_{std::numeric_limits<double>::max()};
  glm::dvec3 high_{std::numeric_limits<double>::lowest()};
};

/// The vertices and `count` points spread over the faces by area.
inline std::vector<glm::dvec3> surfaceSamples(const Mesh& mesh, int count, Random& random) {
  std::vector<double> sums;
  double area = 0.0;
  for (const glm::uvec3& t : mesh.triangles) {
    const glm::dvec3 a = mesh.vertices[t.x];
    area += glm::length(
        glm::cross(glm::dvec3(mesh.vertices[t.y]) - a, glm::dvec3(mesh.vertices[t.z]) - a));
    sums.push_back(area);
  }
  std::vector<glm::dvec3> points(mesh.vertices.begin(), mesh.vertices.end());
  for (int k = 0; k < count; ++k) {
    const auto found = std::upper_bound(sums.begin(), sums.end(), random.uniform() * area);
    const auto index = static_cast<std::size_t>(found - sums.begin());
    const glm::uvec3& t = mesh.triangles[std::min(index, sums.size() - 1)];
    const double s = std::sqrt(random.uniform());
    const double r = random.uniform();
    points.push_back((1.0 - s) * glm::dvec3(mesh.vertices[t.x]) +
                     s * (1.0 - r) * glm::dvec3(mesh.vertices[t.y]) +
                     s * r * glm::dvec3(mesh.vertices[t.z]));
  }
  return points;
}

}  // namespace rangepose::test
