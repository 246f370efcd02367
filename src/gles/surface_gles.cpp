#include "gles/surface_gles.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace rangepose::gles {
namespace {

/// Points of a perspective view count as in front of the camera beyond this depth [mm], as on the
/// host.
constexpr double kNearestMm = 1.0;

glm::vec4 projection(const Camera& camera, const SurfaceWindow& window) {
  const glm::dvec2 scale = camera.orthographic ? glm::dvec2(1.0 / camera.pixel_size_mm)
                                               : glm::dvec2(camera.fx, camera.fy);
  const double step = window.step;
  return {scale.x / step,
          scale.y / step,
          (camera.cx - window.x0) / step,
          (camera.cy - window.y0) / step};
}

Mesh inFront(const Mesh& mesh, const Pose& camera_from_object) {
  Mesh result;
  result.vertices = mesh.vertices;
  const auto in_front = [&](unsigned index) {
    return (camera_from_object * glm::dvec3(mesh.vertices[index])).z > kNearestMm;
  };
  std::copy_if(
      mesh.triangles.begin(),
      mesh.triangles.end(),
      std::back_inserter(result.triangles),
      [&](const glm::uvec3& t) { return in_front(t.x) && in_front(t.y) && in_front(t.z); });
  return result;
}

void draw(Device& device,
          const Framebuffer& target,
          const PixelBox& box,
          const MeshBuffers& buffers,
          const Camera& camera,
          const Pose& camera_from_object,
          const SurfaceWindow& window) {
  const glm::dvec3 center = camera_from_object * buffers.center_mm();
  // A little more than the sphere: its own ends must not be clipped by rounding.
  const double reach = 1.001 * buffers.radius_mm() + 0.001;
  double nearest = center.z - reach;
  if (!camera.orthographic) nearest = std::max(nearest, 0.5 * kNearestMm);
  const double farthest = std::max(center.z + reach, nearest + 1.0);
  Pass pass(device, ProgramId::kSurface, target);
  pass.set("u_rotation", glm::mat3(camera_from_object.rotation))
      .set("u_translation", glm::vec3(center))
      .set("u_projection", projection(camera, window))
      .set("u_depth_range", glm::vec2(nearest, farthest))
      .set("u_window_size", glm::vec2(window.width, window.height))
      .set("u_orthographic", camera.orthographic ? 1 : 0)
      .within(box)
      .depthTest()
      .drawTriangles(buffers.vertices(), buffers.corners(), 1);
}

}  // namespace

Canvas renderSurface(Device& device,
                     const Mesh& mesh,
                     const MeshBuffers& buffers,
                     const Camera& camera,
                     const Pose& camera_from_object,
                     const SurfaceWindow& window) {
  Canvas result(Format::kRgba32f, window.width, window.height);
  const Texture depth(Format::kDepth32f, window.width, window.height);
  const Framebuffer target(result.texture, &depth);
  target.clear(glm::vec4(0.0f));
  target.clearDepth();
  const PixelBox all{0, 0, window.width, window.height};
  renderSurface(device, target, all, mesh, buffers, camera, camera_from_object, window);
  return result;
}

void renderSurface(Device& device,
                   const Framebuffer& target,
                   const PixelBox& box,
                   const Mesh& mesh,
                   const MeshBuffers& buffers,
                   const Camera& camera,
                   const Pose& camera_from_object,
                   const SurfaceWindow& window) {
  const double nearest = (camera_from_object * buffers.center_mm()).z - buffers.radius_mm();
  if (camera.orthographic || nearest > kNearestMm) {
    draw(device, target, box, buffers, camera, camera_from_object, window);
    return;
  }
  const Mesh remaining = inFront(mesh, camera_from_object);
  if (remaining.triangles.empty()) return;
  draw(device, target, box, MeshBuffers(remaining), camera, camera_from_object, window);
}

}  // namespace rangepose::gles
