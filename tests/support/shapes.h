// Round and flat parts, and what a camera measures of them.
#pragma once

#include <cmath>
#include <numbers>

#include "core/camera.h"
#include "geometry/mesh.h"
#include "stages/surface.h"

namespace rangepose::test {

/// Facets of 180 / steps degrees; they lie inside of the sphere by at most radius * (1.6 /
/// steps)^2.
inline Mesh sphereMesh(const glm::dvec3& center, double radius, int steps) {
  Mesh mesh;
  mesh.name = "sphere";
  const unsigned ring = 2 * static_cast<unsigned>(steps);
  for (int i = 0; i <= steps; ++i) {
    for (int j = 0; j < 2 * steps; ++j) {
      const double polar = std::numbers::pi * i / steps;
      const double around = std::numbers::pi * j / steps;
      mesh.vertices.emplace_back(center.x + radius * std::sin(polar) * std::cos(around),
                                 center.y + radius * std::sin(polar) * std::sin(around),
                                 center.z + radius * std::cos(polar));
    }
  }
  for (unsigned i = 0; i < static_cast<unsigned>(steps); ++i) {
    for (unsigned j = 0; j < ring; ++j) {
      const unsigned a = i * ring + j;
      const unsigned b = i * ring + (j + 1) % ring;
      if (i > 0) mesh.triangles.emplace_back(a, b, a + ring);
      if (i + 1 < static_cast<unsigned>(steps)) mesh.triangles.emplace_back(b, b + ring, a + ring);
    }
  }
  return mesh;
}

/// A rectangle in the plane z = 0 of its frame, centred.
inline Mesh plateMesh(double width, double height) {
  Mesh mesh;
  mesh.name = "plate";
  for (int corner = 0; corner < 4; ++corner) {
    const double x = (corner & 1) != 0 ? 0.5 : -0.5;
    const double y = (corner & 2) != 0 ? 0.5 : -0.5;
    mesh.vertices.emplace_back(x * width, y * height, 0.0);
  }
  mesh.triangles = {{0, 1, 3}, {0, 3, 2}};
  return mesh;
}

inline Camera pinholeCamera(int width, int height, double focal_px) {
  Camera camera;
  camera.width = width;
  camera.height = height;
  camera.fx = focal_px;
  camera.fy = focal_px;
  camera.cx = 0.5 * width - 0.5;
  camera.cy = 0.5 * height - 0.5;
  return camera;
}

inline Camera parallelCamera(int width, int height, double pixel_mm) {
  Camera camera = pinholeCamera(width, height, 0.0);
  camera.orthographic = true;
  camera.pixel_size_mm = pixel_mm;
  return camera;
}

/// The rotation of a part of which a camera sees what lies towards `-direction`; given in the
/// part's frame.
inline glm::dmat3 looking(const glm::dvec3& direction) {
  const glm::dvec3 z = glm::normalize(direction);
  const glm::dvec3 x = glm::normalize(glm::cross(glm::dvec3(0.0, 0.3, 1.0), z));
  return glm::transpose(glm::dmat3(x, glm::cross(z, x), z));
}

inline SurfaceWindow wholeWindow(const Camera& camera) {
  return {0, 0, camera.width, camera.height, 1};
}

/// Draws a mesh into a depth image: the nearer surface wins.
inline void measure(DepthImage& image, const Mesh& mesh, const Pose& camera_from_object) {
  if (image.depth_mm.empty())
    image.depth_mm = Image<float>(image.camera.width, image.camera.height);
  const Image<SurfaceTexel> surface =
      host::renderSurface(mesh, image.camera, camera_from_object, wholeWindow(image.camera));
  for (std::size_t i = 0; i < surface.size(); ++i) {
    const float depth = surface.data()[i].w;
    float& nearest = image.depth_mm.data()[i];
    if (depth > 0.0f && (nearest == 0.0f || depth < nearest)) nearest = depth;
  }
}

}  // namespace rangepose::test
