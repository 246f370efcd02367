// The flat faces of a mesh: how large they are, and how thick the part is behind them.
#pragma once

#include <cmath>
#include <vector>

#include "core/glm.h"
#include "core/host_device.h"
#include "geometry/mesh.h"

namespace rangepose {

/// Surface that is tilted against a plane by more than 25 degrees is none of it: the cosine.
inline constexpr double kFlatTiltCos = 0.906;

/// Length and width of a patch of surface in its plane, as if its area were spread evenly over a
/// rectangle [mm].
struct PlaneExtent {
  double length_mm = 0.0;
  double width_mm = 0.0;
};

/// Of points with that covariance [mm^2], in the plane with that unit normal.
RP_HD PlaneExtent extentInPlane(const glm::dmat3& covariance, const glm::dvec3& normal) {
  const bool along_x = normal.x >= 0.9 || normal.x <= -0.9;
  const glm::dvec3 helper = along_x ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0);
  const glm::dvec3 a = glm::normalize(glm::cross(normal, helper));
  const glm::dvec3 b = glm::cross(normal, a);
  const double aa = glm::dot(a, covariance * a);
  const double ab = glm::dot(a, covariance * b);
  const double bb = glm::dot(b, covariance * b);
  const double spread = std::sqrt(0.25 * (aa - bb) * (aa - bb) + ab * ab);
  const double middle = 0.5 * (aa + bb);
  const double narrow = middle > spread ? middle - spread : 0.0;
  return {std::sqrt(12.0 * (middle + spread)), std::sqrt(12.0 * narrow)};
}

/// What of a mesh lies near the plane of one of its triangles and faces as that does.
struct FlatFace {
  double share = 0.0;  ///< of the mesh's area
  PlaneExtent extent;
  double wall_mm = 0.0;  ///< from the triangle's middle straight down to the next surface
};

/// Faces within `tolerance_mm` of their planes, of triangles spread evenly over the area: large
/// faces come often.
std::vector<FlatFace> flatFaces(const Mesh& mesh, double tolerance_mm);

/// Largest length and largest width.
PlaneExtent largestExtent(const std::vector<FlatFace>& faces);

/// The median wall of a part that is mostly large flat faces: of sheet metal, bent or not, the
/// thickness of the sheet [mm]. Infinity for other parts.
double sheetThickness(const std::vector<FlatFace>& faces);

}  // namespace rangepose
