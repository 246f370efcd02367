// A posed part before a floor, half covered by noise and holes: what alignment and verdict are
// compared on.
#pragma once

#include <algorithm>
#include <vector>

#include "cuda/icp_body.h"
#include "cuda/verdict_body.h"
#include "stages/check_host.h"
#include "stages/reference_host.h"
#include "support/box_mesh.h"
#include "support/range_scenes.h"

namespace rangepose::test {

struct RefineScene {
  RefineScene(int views, bool orthographic) : object(objectOf(bracketBoxes(), views, 64, 7)) {
    host::renderReferences(object, {}, {});
    Camera& camera = depth.camera;
    camera.width = 160;
    camera.height = 120;
    camera.fx = 600.0;
    camera.fy = 590.0;
    camera.cx = 80.2;
    camera.cy = 59.4;
    camera.orthographic = orthographic;
    camera.pixel_size_mm = 0.8;
    show(0);
  }

  /// Puts the object in the orientation of a view into the depth image.
  void show(int view) {
    truth.rotation = object.views[static_cast<std::size_t>(view)].rotation;
    truth.translation_mm = glm::dvec3(3.0, -2.0, 420.0) - truth.rotation * object.center_mm;
    const Camera& camera = depth.camera;
    const SurfaceWindow all{0, 0, camera.width, camera.height, 1};
    const Image<SurfaceTexel> surface = host::renderSurface(object.mesh, camera, truth, all);
    depth.depth_mm = Image<float>(camera.width, camera.height);
    Random random(static_cast<unsigned>(view + 1));
    const auto noise = [&](double size) { return static_cast<float>(random.uniform(-size, size)); };
    for (std::size_t i = 0; i < surface.size(); ++i) {
      const float floor = random.index(5) != 0 ? 460.0f + noise(1.0) : 0.0f;
      const float seen = surface.data()[i].w;
      depth.depth_mm.data()[i] = seen != 0.0f ? seen + noise(0.3) : floor;
    }
    for (int i = 0; i < 3000; ++i) {  // something nearer covers a part of it
      depth.depth_mm.data()[random.index(camera.width * camera.height / 3)] = 380.0f;
    }
    rough = truth;
    rough.rotation = rotationFromVector({0.1, -0.05, 0.07}) * rough.rotation;
    rough.translation_mm += glm::dvec3(2.0, 1.0, -3.0);
  }

  /// What the camera sees of the object at a pose, as the estimate renders it.
  struct Seen {
    SurfaceWindow window;
    Image<SurfaceTexel> surface;
  };
  Seen seenAt(const Pose& pose) const {
    constexpr int kRenderPx = 112;
    Seen seen;
    seen.window =
        wholeWindowAround(depth.camera, pose * object.center_mm, object.radius_mm, kRenderPx);
    seen.surface = host::renderSurface(object.mesh, depth.camera, pose, seen.window);
    return seen;
  }

  /// Around the object at a pose, in the camera frame.
  Sphere sphereAt(const Pose& pose) const { return {pose * object.center_mm, object.radius_mm}; }

  cuda::IcpTask icpTask(const std::vector<SurfacePoint>& points, const IcpOptions& options) const {
    cuda::IcpTask task;
    task.point_count = static_cast<int>(points.size());
    task.start = rough;
    task.center_mm = object.center_mm;
    task.radius_mm = object.radius_mm;
    task.options = options;
    task.shrink = icpShrink(options);
    return task;
  }

  ReferenceObject object;
  DepthImage depth;
  Pose truth;  ///< camera_from_object
  Pose rough;  ///< a little beside it
};

/// Farthest that a corner of a box around the object moves between two poses [mm].
inline double farthestCorner(const ReferenceObject& object, const Pose& a, const Pose& b) {
  double farthest = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec3 side(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
    const glm::dvec3 point = object.center_mm + object.radius_mm * side;
    farthest = std::max(farthest, glm::distance(a * point, b * point));
  }
  return farthest;
}

}  // namespace rangepose::test
