#include "sim/height_field.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/error.h"

namespace rangepose {
namespace {

constexpr float kNothing = std::numeric_limits<float>::infinity();

void include(PartColumns& columns, int i, int j, double z) {
  float& bottom = columns.bottom.at(i, j);
  float& top = columns.top.at(i, j);
  bottom = std::min(bottom, static_cast<float>(z));
  top = std::max(top, static_cast<float>(z));
}

/// Points of an edge, no further apart than half a column. Coordinates in cells, relative to the
/// field.
void includeEdge(PartColumns& columns, const glm::dvec3& a, const glm::dvec3& b) {
  const double longest = std::max(std::abs(b.x - a.x), std::abs(b.y - a.y));
  const int steps = 1 + static_cast<int>(2.0 * longest);
  for (int k = 0; k <= steps; ++k) {
    const glm::dvec3 p = a + (b - a) * (static_cast<double>(k) / steps);
    include(columns, static_cast<int>(p.x), static_cast<int>(p.y), p.z);
  }
}

/// Heights of a triangle's plane over the centres of the columns inside of it.
void includeFace(PartColumns& columns,
                 const glm::dvec3& a,
                 const glm::dvec3& b,
                 const glm::dvec3& c) {
  const double area = (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
  if (std::abs(area) < 1e-12) return;
  const int i0 = static_cast<int>(std::min({a.x, b.x, c.x}));
  const int i1 = static_cast<int>(std::max({a.x, b.x, c.x}));
  const int j0 = static_cast<int>(std::min({a.y, b.y, c.y}));
  const int j1 = static_cast<int>(std::max({a.y, b.y, c.y}));
  for (int j = j0; j <= j1; ++j) {
    for (int i = i0; i <= i1; ++i) {
      const double x = i + 0.5 - a.x;
      const double y = j + 0.5 - a.y;
      const double s = (x * (c.y - a.y) - (c.x - a.x) * y) / area;
      const double t = ((b.x - a.x) * y - x * (b.y - a.y)) / area;
      if (s < 0.0 || t < 0.0 || s + t > 1.0) continue;
      include(columns, i, j, a.z + s * (b.z - a.z) + t * (c.z - a.z));
    }
  }
}

/// Each column takes in its eight neighbours.
void widen(PartColumns& columns) {
  const PartColumns narrow = columns;
  const int width = columns.bottom.width();
  const int height = columns.bottom.height();
  for (int j = 1; j < height - 1; ++j) {
    for (int i = 1; i < width - 1; ++i) {
      if (narrow.bottom.at(i, j) == kNothing) continue;
      for (int n = 0; n < 9; ++n) {
        const int x = i + n % 3 - 1;
        const int y = j + n / 3 - 1;
        columns.bottom.at(x, y) = std::min(columns.bottom.at(x, y), narrow.bottom.at(i, j));
        columns.top.at(x, y) = std::max(columns.top.at(x, y), narrow.top.at(i, j));
      }
    }
  }
}

}  // namespace

PartColumns columnsOf(const Mesh& mesh,
                      const glm::dvec3& center_mm,
                      const glm::dmat3& rotation,
                      const glm::dvec2& at_mm,
                      double cell_mm) {
  std::vector<glm::dvec3> points(mesh.vertices.size());
  glm::dvec2 low(std::numeric_limits<double>::max());
  glm::dvec2 high(std::numeric_limits<double>::lowest());
  for (std::size_t k = 0; k < points.size(); ++k) {
    const glm::dvec3 turned = rotation * (glm::dvec3(mesh.vertices[k]) - center_mm);
    points[k] = {(turned.x + at_mm.x) / cell_mm, (turned.y + at_mm.y) / cell_mm, turned.z};
    low = glm::min(low, glm::dvec2(points[k]));
    high = glm::max(high, glm::dvec2(points[k]));
  }
  PartColumns columns;
  columns.x0 = static_cast<int>(std::floor(low.x)) - 1;
  columns.y0 = static_cast<int>(std::floor(low.y)) - 1;
  const int width = static_cast<int>(std::floor(high.x)) + 2 - columns.x0;
  const int height = static_cast<int>(std::floor(high.y)) + 2 - columns.y0;
  columns.bottom = Image<float>(width, height, kNothing);
  columns.top = Image<float>(width, height, -kNothing);
  for (glm::dvec3& point : points) point -= glm::dvec3(columns.x0, columns.y0, 0.0);
  for (const glm::uvec3& triangle : mesh.triangles) {
    for (int k = 0; k < 3; ++k) {
      const unsigned from = triangle[k];
      const unsigned to = triangle[(k + 1) % 3];
      // A closed mesh has each edge twice, once in either direction.
      if (from < to) includeEdge(columns, points[from], points[to]);
    }
    includeFace(columns, points[triangle.x], points[triangle.y], points[triangle.z]);
  }
  widen(columns);
  return columns;
}

HeapTop::HeapTop(double extent_mm, double cell_mm)
    : half_(static_cast<int>(std::ceil(extent_mm / cell_mm))),
      cell_mm_(cell_mm),
      top_(2 * half_, 2 * half_, 0.0f) {}

float HeapTop::at(int i, int j) const {
  return top_.contains(i + half_, j + half_) ? top_.at(i + half_, j + half_) : 0.0f;
}

double HeapTop::restingHeight(const PartColumns& part) const {
  float lift = -kNothing;
  for (int j = 0; j < part.bottom.height(); ++j) {
    for (int i = 0; i < part.bottom.width(); ++i) {
      lift = std::max(lift, at(part.x0 + i, part.y0 + j) - part.bottom.at(i, j));
    }
  }
  return lift;
}

void HeapTop::add(const PartColumns& part, double height_mm) {
  RP_CHECK(part.x0 >= -half_ && part.y0 >= -half_ && part.x0 + part.top.width() <= half_ &&
               part.y0 + part.top.height() <= half_,
           "part reaches beyond the heap's grid; give a larger extent");
  for (int j = 0; j < part.top.height(); ++j) {
    for (int i = 0; i < part.top.width(); ++i) {
      float& top = top_.at(part.x0 + i + half_, part.y0 + j + half_);
      top = std::max(top, part.top.at(i, j) + static_cast<float>(height_mm));
    }
  }
}

}  // namespace rangepose
