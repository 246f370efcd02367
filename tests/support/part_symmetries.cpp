#include "support/part_symmetries.h"

#include <algorithm>
#include <limits>
#include <numbers>

namespace rangepose::test {

std::vector<Pose> symmetriesOf(const std::string& part, const Mesh& mesh) {
  // Order and axis of the rotations; see models/README.md.
  int order = 1;
  glm::dvec3 axis(0.0, 0.0, 1.0);
  if (part == "bolt") order = 6;
  if (part == "t_pipe") order = 2;
  if (part == "elbow") {
    order = 2;
    axis = glm::normalize(glm::dvec3(1.0, 1.0, 0.0));
  }
  const Sphere sphere = boundingSphere(mesh);
  std::vector<Pose> symmetries;
  for (int k = 0; k < order; ++k) {
    Pose symmetry;
    symmetry.rotation = rotationFromVector(axis * (2.0 * std::numbers::pi * k / order));
    symmetry.translation_mm = sphere.center_mm - symmetry.rotation * sphere.center_mm;
    symmetries.push_back(symmetry);
  }
  return symmetries;
}

double vertexError(const Mesh& mesh,
                   const std::vector<Pose>& symmetries,
                   const Pose& estimate,
                   const Pose& truth) {
  double best = std::numeric_limits<double>::max();
  for (const Pose& symmetry : symmetries) {
    const Pose same = truth * symmetry;
    double sum = 0.0;
    for (const glm::vec3& vertex : mesh.vertices) {
      sum += glm::distance(estimate * glm::dvec3(vertex), same * glm::dvec3(vertex));
    }
    best = std::min(best, sum / static_cast<double>(mesh.vertices.size()));
  }
  return best;
}

}  // namespace rangepose::test
