#include "geometry/mesh.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "core/error.h"

namespace rangepose {
namespace {

struct Bounds {
  glm::dvec3 low{std::numeric_limits<double>::max()};
  glm::dvec3 high{std::numeric_limits<double>::lowest()};
};

Bounds bounds(const Mesh& mesh) {
  Bounds box;
  for (const glm::vec3& vertex : mesh.vertices) {
    box.low = glm::min(box.low, glm::dvec3(vertex));
    box.high = glm::max(box.high, glm::dvec3(vertex));
  }
  return box;
}

bool hasArea(const Mesh& mesh, const glm::uvec3& triangle) {
  const glm::dvec3 a = mesh.vertices[triangle.x];
  const glm::dvec3 b = mesh.vertices[triangle.y];
  const glm::dvec3 c = mesh.vertices[triangle.z];
  return glm::length(glm::cross(b - a, c - a)) > 0.0;
}

}  // namespace

void checkMesh(const Mesh& mesh) {
  const std::string where = "mesh " + mesh.name + ": ";
  if (mesh.triangles.empty())
    throw Error(where + "no faces; give a triangle mesh, not a point cloud");
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const glm::vec3& v = mesh.vertices[i];
    if (!std::isfinite(v.x) || !std::isfinite(v.y) || !std::isfinite(v.z)) {
      throw Error(where + "vertex " + std::to_string(i) + " is not finite; repair the file");
    }
  }
  bool any_area = false;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const glm::uvec3& t = mesh.triangles[i];
    if (std::max({t.x, t.y, t.z}) >= mesh.vertices.size()) {
      throw Error(where + "face " + std::to_string(i) + " names a vertex that does not exist (" +
                  std::to_string(mesh.vertices.size()) + " vertices); repair the file");
    }
    any_area = any_area || hasArea(mesh, t);
  }
  if (!any_area) throw Error(where + "no face has an area; repair the file");
}

Mesh cleaned(const Mesh& mesh) {
  Mesh result;
  result.name = mesh.name;
  constexpr unsigned kUnused = std::numeric_limits<unsigned>::max();
  std::vector<unsigned> new_index(mesh.vertices.size(), kUnused);
  for (const glm::uvec3& triangle : mesh.triangles) {
    if (!hasArea(mesh, triangle)) continue;
    glm::uvec3 renamed{};
    for (int corner = 0; corner < 3; ++corner) {
      const unsigned old = triangle[corner];
      if (new_index[old] == kUnused) {
        new_index[old] = static_cast<unsigned>(result.vertices.size());
        result.vertices.push_back(mesh.vertices[old]);
      }
      renamed[corner] = new_index[old];
    }
    result.triangles.push_back(renamed);
  }
  return result;
}

double diameter(const Mesh& mesh) {
  // A vertex can only be an end of the diameter if it is farther from the centre than the best
  // half-length known: that leaves few of a large mesh to be paired.
  struct Far {
    glm::dvec3 point;
    double reach;  ///< from the centre
  };
  const Sphere sphere = boundingSphere(mesh);
  std::vector<Far> far;
  far.reserve(mesh.vertices.size());
  for (const glm::vec3& vertex : mesh.vertices) {
    far.push_back({glm::dvec3(vertex), glm::distance(glm::dvec3(vertex), sphere.center_mm)});
  }
  std::sort(far.begin(), far.end(), [](const Far& a, const Far& b) { return a.reach > b.reach; });
  double best = 0.0;
  double best_squared = 0.0;
  for (std::size_t i = 0; i < far.size(); ++i) {
    if (2.0 * far[i].reach <= best) break;
    for (std::size_t j = i + 1; j < far.size(); ++j) {
      if (far[i].reach + far[j].reach <= best) break;
      const glm::dvec3 gap = far[i].point - far[j].point;
      const double squared = glm::dot(gap, gap);
      if (squared <= best_squared) continue;
      best_squared = squared;
      best = std::sqrt(squared);
    }
  }
  return best;
}

glm::dvec3 boundingBoxCenter(const Mesh& mesh) {
  const Bounds box = bounds(mesh);
  return 0.5 * (box.low + box.high);
}

double boundingBoxDiagonal(const Mesh& mesh) {
  const Bounds box = bounds(mesh);
  return glm::distance(box.low, box.high);
}

}  // namespace rangepose
