#include "geometry/triangle_tree.h"

#include <algorithm>
#include <array>

#include "core/error.h"

namespace rangepose {
namespace {

constexpr int kLeafTriangles = 4;
constexpr int kMaxDepth = 64;  // halves each time: 2^64 triangles

double squared(const glm::dvec3& v) { return glm::dot(v, v); }

glm::dvec3 nearestOnSegment(const glm::dvec3& point, const glm::dvec3& a, const glm::dvec3& b) {
  const glm::dvec3 along = b - a;
  const double length = squared(along);
  if (length == 0.0) return a;
  return a + std::clamp(glm::dot(point - a, along) / length, 0.0, 1.0) * along;
}

double squaredToBox(const glm::dvec3& point, const glm::dvec3& low, const glm::dvec3& high) {
  return squared(point - glm::clamp(point, low, high));
}

}  // namespace

glm::dvec3 nearestOnTriangle(const glm::dvec3& point,
                             const glm::dvec3& a,
                             const glm::dvec3& b,
                             const glm::dvec3& c) {
  const glm::dvec3 normal = glm::cross(b - a, c - a);
  const double area = squared(normal);
  if (area > 0.0) {
    // Inside of the prism over the triangle the nearest point is the projection.
    const double wa = glm::dot(glm::cross(c - b, point - b), normal);
    const double wb = glm::dot(glm::cross(a - c, point - c), normal);
    const double wc = glm::dot(glm::cross(b - a, point - a), normal);
    if (wa >= 0.0 && wb >= 0.0 && wc >= 0.0) {
      return point - glm::dot(point - a, normal) / area * normal;
    }
  }
  const std::array<glm::dvec3, 3> sides = {
      nearestOnSegment(point, a, b), nearestOnSegment(point, b, c), nearestOnSegment(point, c, a)};
  return *std::min_element(sides.begin(), sides.end(), [&](const auto& p, const auto& q) {
    return squared(p - point) < squared(q - point);
  });
}

TriangleTree::TriangleTree(const Mesh& mesh) {
  checkMesh(mesh);
  triangles_.reserve(mesh.triangles.size());
  for (const glm::uvec3& corners : mesh.triangles) {
    triangles_.push_back({mesh.vertices[corners.x],
                          mesh.vertices[corners.y],
                          mesh.vertices[corners.z],
                          static_cast<int>(triangles_.size())});
  }
  nodes_.reserve(triangles_.size());
  nodes_.emplace_back();
  split(0, 0, static_cast<int>(triangles_.size()));
}

void TriangleTree::split(std::size_t node, int first, int count) {
  glm::dvec3 low(std::numeric_limits<double>::max());
  glm::dvec3 high(std::numeric_limits<double>::lowest());
  const auto begin = triangles_.begin() + first;
  std::for_each(begin, begin + count, [&](const Triangle& t) {
    low = glm::min(low, glm::min(t.a, glm::min(t.b, t.c)));
    high = glm::max(high, glm::max(t.a, glm::max(t.b, t.c)));
  });
  nodes_[node] = {low, high, first, count};
  if (count <= kLeafTriangles) return;
  const glm::dvec3 size = high - low;
  int axis = size.x >= size.y ? 0 : 1;
  if (size.z > size[axis]) axis = 2;
  const int half = count / 2;
  const auto before = [axis](const Triangle& p, const Triangle& q) {
    const double left = p.a[axis] + p.b[axis] + p.c[axis];
    const double right = q.a[axis] + q.b[axis] + q.c[axis];
    return left < right || (left == right && p.index < q.index);
  };
  std::nth_element(begin, begin + half, begin + count, before);
  const std::size_t child = nodes_.size();
  nodes_.resize(child + 2);
  nodes_[node].first = static_cast<int>(child);
  nodes_[node].count = 0;
  split(child, first, half);
  split(child + 1, first + half, count - half);
}

NearestPoint TriangleTree::nearest(const glm::dvec3& point_mm, const NearestPoint& guess) const {
  struct Waiting {
    std::size_t node;
    double squared_mm2;
  };
  std::array<Waiting, kMaxDepth> stack;
  std::size_t waiting = 0;
  NearestPoint best = guess;
  if (guess.triangle >= 0) best.squared_mm2 = squared(point_mm - guess.point_mm);
  stack[waiting++] = {0, 0.0};
  while (waiting > 0) {
    const Waiting next = stack[--waiting];
    if (next.squared_mm2 >= best.squared_mm2) continue;
    const Node& node = nodes_[next.node];
    for (int i = node.first; i < node.first + node.count; ++i) {
      const Triangle& t = triangles_[static_cast<std::size_t>(i)];
      const glm::dvec3 candidate = nearestOnTriangle(point_mm, t.a, t.b, t.c);
      const double distance = squared(candidate - point_mm);
      if (distance < best.squared_mm2) best = {candidate, distance, t.index};
    }
    if (node.count > 0) continue;
    const std::size_t left = static_cast<std::size_t>(node.first);
    const double to_left = squaredToBox(point_mm, nodes_[left].low, nodes_[left].high);
    const double to_right = squaredToBox(point_mm, nodes_[left + 1].low, nodes_[left + 1].high);
    const bool left_first = to_left <= to_right;
    stack[waiting++] = left_first ? Waiting{left + 1, to_right} : Waiting{left, to_left};
    stack[waiting++] = left_first ? Waiting{left, to_left} : Waiting{left + 1, to_right};
  }
  return best;
}

bool TriangleTree::touches(const glm::dvec3& point_mm, double reach_mm) const {
  std::array<std::size_t, kMaxDepth> stack;
  std::size_t waiting = 0;
  const double reach = reach_mm * reach_mm;
  stack[waiting++] = 0;
  while (waiting > 0) {
    const Node& node = nodes_[stack[--waiting]];
    if (squaredToBox(point_mm, node.low, node.high) > reach) continue;
    for (int i = node.first; i < node.first + node.count; ++i) {
      const Triangle& t = triangles_[static_cast<std::size_t>(i)];
      if (squared(nearestOnTriangle(point_mm, t.a, t.b, t.c) - point_mm) <= reach) return true;
    }
    if (node.count > 0) continue;
    stack[waiting++] = static_cast<std::size_t>(node.first) + 1;
    stack[waiting++] = static_cast<std::size_t>(node.first);
  }
  return false;
}

}  // namespace rangepose
