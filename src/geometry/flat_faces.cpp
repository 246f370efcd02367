#include "geometry/flat_faces.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/parallel.h"
#include "geometry/triangle_corners.h"

namespace rangepose {
namespace {

constexpr int kTried = 48;

glm::dvec3 middleOf(const TriangleCorners& triangle) {
  return (triangle.a + triangle.b + triangle.c) / 3.0;
}

/// How far it is from `from` along the unit vector `down` to the triangle (Moeller and Trumbore
/// 1997); infinity where it is missed.
double hitBy(const glm::dvec3& from, const glm::dvec3& down, const TriangleCorners& triangle) {
  constexpr double kMissed = std::numeric_limits<double>::infinity();
  const glm::dvec3 ab = triangle.b - triangle.a;
  const glm::dvec3 ac = triangle.c - triangle.a;
  const glm::dvec3 p = glm::cross(down, ac);
  const double determinant = glm::dot(ab, p);
  if (determinant == 0.0) return kMissed;
  const glm::dvec3 s = from - triangle.a;
  const double u = glm::dot(s, p) / determinant;
  if (!(u >= 0.0 && u <= 1.0)) return kMissed;
  const glm::dvec3 q = glm::cross(s, ab);
  const double v = glm::dot(down, q) / determinant;
  if (!(v >= 0.0 && u + v <= 1.0)) return kMissed;
  return glm::dot(ac, q) / determinant;
}

FlatFace faceAround(const Mesh& mesh,
                    const TriangleCorners& seed,
                    double total_mm2,
                    double tolerance_mm) {
  const glm::dvec3 normal = glm::normalize(seed.cross());
  const glm::dvec3 from = middleOf(seed);
  FlatFace face;
  face.wall_mm = std::numeric_limits<double>::infinity();
  double twice_mm2 = 0.0;
  glm::dvec3 mean(0.0);
  glm::dmat3 second(0.0);
  for (const glm::uvec3& triangle : mesh.triangles) {
    const TriangleCorners corners(mesh, triangle);
    const double behind = hitBy(from, -normal, corners);
    if (behind > 1e-3 * tolerance_mm) face.wall_mm = std::min(face.wall_mm, behind);
    const glm::dvec3 cross = corners.cross();
    const double twice = glm::length(cross);
    if (glm::dot(cross, normal) < kFlatTiltCos * twice) continue;
    const glm::dvec3 middle = middleOf(corners) - from;
    if (std::abs(glm::dot(normal, middle)) > tolerance_mm) continue;
    twice_mm2 += twice;
    mean += twice * middle;
    // Second moments of a triangle: exact from its corners and their sum.
    second += twice * 0.75 * glm::outerProduct(middle, middle);
    for (const glm::dvec3& corner : {corners.a, corners.b, corners.c})
      second += twice / 12.0 * glm::outerProduct(corner - from, corner - from);
  }
  mean /= twice_mm2;
  face.share = 0.5 * twice_mm2 / total_mm2;
  face.extent = extentInPlane(second / twice_mm2 - glm::outerProduct(mean, mean), normal);
  return face;
}

}  // namespace

std::vector<FlatFace> flatFaces(const Mesh& mesh, double tolerance_mm) {
  checkMesh(mesh);
  const std::vector<double> until = cumulativeAreas(mesh);
  const double total = until.back();
  std::vector<FlatFace> faces(kTried);
  parallelFor(kTried, 1, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      // The first that reaches so far: it has area.
      const auto piece =
          std::lower_bound(until.begin(), until.end() - 1, total * (i + 0.5) / kTried);
      const auto index = static_cast<std::size_t>(std::distance(until.begin(), piece));
      const TriangleCorners seed(mesh, mesh.triangles[index]);
      faces[static_cast<std::size_t>(i)] = faceAround(mesh, seed, total, tolerance_mm);
    }
  });
  return faces;
}

PlaneExtent largestExtent(const std::vector<FlatFace>& faces) {
  PlaneExtent largest;
  for (const FlatFace& face : faces) {
    largest.length_mm = std::max(largest.length_mm, face.extent.length_mm);
    largest.width_mm = std::max(largest.width_mm, face.extent.width_mm);
  }
  return largest;
}

double sheetThickness(const std::vector<FlatFace>& faces) {
  constexpr double kLargeFace =
      0.12;  // of the area: of an L of sheet each leg has a quarter a side
  std::vector<double> walls;
  for (const FlatFace& face : faces) {
    if (face.share >= kLargeFace) walls.push_back(face.wall_mm);
  }
  if (2 * walls.size() < faces.size() || walls.empty()) {
    return std::numeric_limits<double>::infinity();
  }
  const auto median = walls.begin() + static_cast<std::ptrdiff_t>(walls.size() / 2);
  std::nth_element(walls.begin(), median, walls.end());
  return *median;
}

}  // namespace rangepose
