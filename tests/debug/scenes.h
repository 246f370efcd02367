// Small scenes whose pictures can be foretold.
#pragma once

#include <cmath>
#include <opencv2/core.hpp>
#include <ostream>

#include "core/camera.h"
#include "debug/overlay.h"
#include "geometry/mesh.h"
#include "stages/surface.h"

namespace rangepose::testing {

/// An axis-parallel box about the origin [mm].
inline Mesh box(float x, float y, float z) {
  Mesh mesh;
  mesh.name = "box";
  for (int i = 0; i < 8; ++i) {
    mesh.vertices.emplace_back(((i & 1) != 0 ? 0.5f : -0.5f) * x,
                               ((i & 2) != 0 ? 0.5f : -0.5f) * y,
                               ((i & 4) != 0 ? 0.5f : -0.5f) * z);
  }
  mesh.triangles = {{0, 2, 1},
                    {1, 2, 3},
                    {4, 5, 6},
                    {5, 7, 6},
                    {0, 1, 4},
                    {1, 5, 4},
                    {2, 6, 3},
                    {3, 6, 7},
                    {0, 4, 2},
                    {2, 4, 6},
                    {1, 3, 5},
                    {3, 7, 5}};
  return mesh;
}

inline Camera smallCamera() {
  Camera camera;
  camera.width = 160;
  camera.height = 120;
  camera.fx = camera.fy = 150.0;
  camera.cx = 79.5;
  camera.cy = 59.5;
  return camera;
}

inline Pose facing(double x_mm, double y_mm, double z_mm) {
  Pose pose;
  pose.translation_mm = {x_mm, y_mm, z_mm};
  return pose;
}

/// What the camera measures of a posed mesh before a wall; a wall at 0 is no wall.
inline DepthImage scan(const Mesh& mesh, const Pose& camera_from_object, float wall_mm) {
  DepthImage image{smallCamera(), Image<float>(160, 120, wall_mm)};
  const Image<SurfaceTexel> surface =
      host::renderSurface(mesh, image.camera, camera_from_object, {0, 0, 160, 120, 1});
  for (std::size_t i = 0; i < surface.size(); ++i) {
    if (surface.data()[i].w > 0.0f) image.depth_mm.data()[i] = surface.data()[i].w;
  }
  return image;
}

inline debug::OverlayPose posed(const Mesh& mesh, const Pose& pose) {
  return {&mesh, pose, 0.75, "1 box"};
}

enum class Tone { kGrey, kRed, kGreen, kBlue, kOther };

inline std::ostream& operator<<(std::ostream& out, Tone tone) {
  constexpr const char* kNames[] = {"grey", "red", "green", "blue", "other"};
  return out << kNames[static_cast<int>(tone)];
}

/// The channel that stands out clearly, as an eye would name it.
inline Tone toneOf(const cv::Vec3b& pixel) {
  const int blue = pixel[0];
  const int green = pixel[1];
  const int red = pixel[2];
  constexpr int kClear = 25;
  if (std::abs(red - green) < 4 && std::abs(green - blue) < 4) return Tone::kGrey;
  if (red > green + kClear && red > blue + kClear) return Tone::kRed;
  if (green > red + kClear && green > blue + kClear) return Tone::kGreen;
  if (blue > red + kClear && blue > green + kClear) return Tone::kBlue;
  return Tone::kOther;
}

/// The pixel of a panel that shows depth pixel (u, v).
inline cv::Vec3b pixelOf(const debug::OverlayPicture& picture,
                         const debug::OverlayPanel& panel,
                         int u,
                         int v) {
  const int x = panel.box.x + static_cast<int>((u - panel.source.x0 + 0.5) * panel.scale);
  const int y = panel.box.y + static_cast<int>((v - panel.source.y0 + 0.5) * panel.scale);
  return picture.image.at<cv::Vec3b>(y, x);
}

}  // namespace rangepose::testing
