#include "debug/model_layer.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "core/parallel.h"
#include "debug/overlay_legend.h"

namespace rangepose::debug {
namespace {

/// Models are painted this many times finer than shown: that is what makes lines smooth.
constexpr int kSupersampling = 2;
constexpr int kMaxWindowPx = 1 << 20;
constexpr double kFillOpacity = 0.55;
constexpr float kCreaseCos = 0.82f;       // 35 degrees: above the facets of usual CAD exports
constexpr double kStepOfDiameter = 0.02;  // an edge where the surface jumps by more

cv::Vec3d channels(const cv::Scalar& colour) { return {colour[0], colour[1], colour[2]}; }

SurfaceWindow windowOf(const OverlayPose& pose, const Camera& camera) {
  const Sphere sphere = boundingSphere(*pose.mesh);
  return windowAround(
      camera, pose.camera_from_object * sphere.center_mm, sphere.radius_mm, kMaxWindowPx);
}

/// Marks pixels on the border of what one pose shows.
cv::Mat outlineMask(const ModelLayer& layer) {
  cv::Mat mask(layer.owner.height(), layer.owner.width(), CV_8UC1, cv::Scalar(0));
  for (int y = 0; y < layer.owner.height(); ++y) {
    for (int x = 0; x < layer.owner.width(); ++x) {
      const int owner = layer.owner.at(x, y);
      if (owner < 0) continue;
      for (int k = 0; k < 4; ++k) {
        const int nx = x + (k == 0) - (k == 1);
        const int ny = y + (k == 2) - (k == 3);
        if (!layer.owner.contains(nx, ny)) continue;
        if (layer.owner.at(nx, ny) != owner) mask.at<unsigned char>(y, x) = 255;
      }
    }
  }
  return mask;
}

/// Whether two neighbouring pixels of one model lie on different faces of its shape.
bool isFeature(const SurfaceTexel& a,
               const SurfaceTexel& b,
               const glm::dvec3& a_mm,
               const glm::dvec3& b_mm,
               double step_mm) {
  if (glm::dot(glm::vec3(a), glm::vec3(b)) < kCreaseCos) return true;
  // Off the other's plane on both sides: a step, not a slope.
  const double off_a = std::abs(glm::dot(glm::dvec3(glm::vec3(a)), b_mm - a_mm));
  const double off_b = std::abs(glm::dot(glm::dvec3(glm::vec3(b)), b_mm - a_mm));
  return std::min(off_a, off_b) > step_mm;
}

/// Marks creases and inner steps of the models: `step_mm` per pose.
cv::Mat featureMask(const ModelLayer& layer,
                    const Camera& camera,
                    const std::vector<double>& step_mm) {
  cv::Mat mask(layer.owner.height(), layer.owner.width(), CV_8UC1, cv::Scalar(0));
  for (int y = 0; y + 1 < layer.owner.height(); ++y) {
    for (int x = 0; x + 1 < layer.owner.width(); ++x) {
      const int owner = layer.owner.at(x, y);
      if (owner < 0) continue;
      const SurfaceTexel& here = layer.surface.at(x, y);
      const glm::dvec3 here_mm = camera.unproject(x, y, here.w);
      for (int k = 0; k < 2; ++k) {
        const int nx = x + (k == 0);
        const int ny = y + (k == 1);
        if (layer.owner.at(nx, ny) != owner) continue;
        const SurfaceTexel& there = layer.surface.at(nx, ny);
        const glm::dvec3 there_mm = camera.unproject(nx, ny, there.w);
        if (isFeature(here, there, here_mm, there_mm, step_mm[static_cast<std::size_t>(owner)])) {
          mask.at<unsigned char>(y, x) = 255;
        }
      }
    }
  }
  return mask;
}

cv::Mat widened(const cv::Mat& mask, int width) {
  cv::Mat wide;
  cv::dilate(mask, wide, cv::getStructuringElement(cv::MORPH_ELLIPSE, {width, width}));
  return wide;
}

void blend(cv::Mat& picture, const cv::Mat& mask, const cv::Vec3d& colour, double opacity) {
  for (int y = 0; y < picture.rows; ++y) {
    for (int x = 0; x < picture.cols; ++x) {
      if (mask.at<unsigned char>(y, x) == 0) continue;
      cv::Vec3b& pixel = picture.at<cv::Vec3b>(y, x);
      const cv::Vec3d mixed = (1.0 - opacity) * cv::Vec3d(pixel) + opacity * colour;
      pixel = cv::Vec3b(mixed);
    }
  }
}

/// Depth of the face seen at `seen_mm`, carried along its plane to the ray through a depth pixel's
/// centre: enlarged slopes would else differ from the data by their slope within a pixel.
double depthAtPixel(
    const Camera& camera, const SurfaceTexel& texel, const glm::dvec3& seen_mm, int u, int v) {
  constexpr double kGrazing = 0.15;
  const glm::dvec3 normal = glm::dvec3(glm::vec3(texel));
  if (camera.orthographic) {
    if (std::abs(normal.z) < kGrazing) return seen_mm.z;
    const glm::dvec3 foot = camera.unproject(u, v, seen_mm.z);
    return seen_mm.z + glm::dot(normal, seen_mm - foot) / normal.z;
  }
  const glm::dvec3 ray = camera.unproject(u, v, 1.0);
  const double facing = glm::dot(normal, ray);
  if (std::abs(facing) < kGrazing * glm::length(ray)) return seen_mm.z;
  return glm::dot(normal, seen_mm) / facing;
}

/// Lays the difference colours over the relief; the model's own shading keeps its shape readable.
void fill(cv::Mat& picture,
          const DepthImage& image,
          const ModelLayer& layer,
          const PictureView& view,
          const Camera& view_camera,
          double tolerance_mm) {
  parallelFor(picture.rows, 32, [&](int begin, int end) {
    for (int y = begin; y < end; ++y) {
      for (int x = 0; x < picture.cols; ++x) {
        if (layer.owner.at(x, y) < 0) continue;
        const SurfaceTexel& model = layer.surface.at(x, y);
        const int u = view.sourceX(x);
        const int v = view.sourceY(y);
        const float scene_mm = image.depth_mm.at(u, v);
        const glm::dvec3 seen_mm = view_camera.unproject(x, y, model.w);
        const double model_mm = depthAtPixel(image.camera, model, seen_mm, u, v);
        const cv::Vec3d tint = scene_mm == 0.0f
                                   ? channels(kMissingTint)
                                   : cv::Vec3d(differenceColour(scene_mm - model_mm, tolerance_mm));
        const double shade = 0.65 + 0.35 * std::abs(model.z);
        cv::Vec3b& pixel = picture.at<cv::Vec3b>(y, x);
        pixel = cv::Vec3b((1.0 - kFillOpacity) * cv::Vec3d(pixel) + kFillOpacity * shade * tint);
      }
    }
  });
}

}  // namespace

ModelLayer renderModels(const std::vector<OverlayPose>& poses, const Camera& camera) {
  ModelLayer layer{Image<SurfaceTexel>(camera.width, camera.height, SurfaceTexel(0.0f)),
                   Image<int>(camera.width, camera.height, -1)};
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const SurfaceWindow window = windowOf(poses[i], camera);
    const Image<SurfaceTexel> part =
        host::renderSurface(*poses[i].mesh, camera, poses[i].camera_from_object, window);
    for (int y = 0; y < part.height(); ++y) {
      for (int x = 0; x < part.width(); ++x) {
        const SurfaceTexel& texel = part.at(x, y);
        if (texel.w <= 0.0f || !layer.owner.contains(window.x0 + x, window.y0 + y)) continue;
        SurfaceTexel& seen = layer.surface.at(window.x0 + x, window.y0 + y);
        if (seen.w > 0.0f && seen.w <= texel.w) continue;
        seen = texel;
        layer.owner.at(window.x0 + x, window.y0 + y) = static_cast<int>(i);
      }
    }
  }
  return layer;
}

cv::Mat paintModels(const DepthImage& image,
                    const cv::Mat& relief_pixels,
                    const std::vector<OverlayPose>& poses,
                    const PictureView& view,
                    double tolerance_mm) {
  PictureView fine = view;
  fine.scale *= kSupersampling;
  fine.width *= kSupersampling;
  fine.height *= kSupersampling;
  const Camera camera = fine.camera(image.camera);
  const ModelLayer layer = renderModels(poses, camera);
  std::vector<double> step_mm;
  step_mm.reserve(poses.size());
  for (const OverlayPose& pose : poses) step_mm.push_back(kStepOfDiameter * diameter(*pose.mesh));

  cv::Mat picture = shown(relief_pixels, fine);
  fill(picture, image, layer, fine, camera, tolerance_mm);
  blend(picture, widened(featureMask(layer, camera, step_mm), 2), {20, 20, 20}, 0.6);
  const cv::Mat outline = outlineMask(layer);
  blend(picture, widened(outline, 3 * kSupersampling + 1), {0, 0, 0}, 0.55);
  blend(picture, widened(outline, kSupersampling + 1), channels(kOutlineColour), 1.0);
  cv::Mat result;
  cv::resize(picture, result, {view.width, view.height}, 0, 0, cv::INTER_AREA);
  return result;
}

void drawAxes(cv::Mat& picture, const OverlayPose& pose, const Camera& camera) {
  constexpr int kShift = 4;  // fractional bits of the coordinates
  const double length_mm = 0.6 * boundingSphere(*pose.mesh).radius_mm;
  const auto inFront = [&](const glm::dvec3& p) { return camera.orthographic || p.z > 1.0; };
  const auto fixedPoint = [&](const glm::dvec2& p) {
    return cv::Point(cv::saturate_cast<int>(p.x * (1 << kShift)),
                     cv::saturate_cast<int>(p.y * (1 << kShift)));
  };
  const glm::dvec3 origin = pose.camera_from_object.translation_mm;
  if (!inFront(origin)) return;
  for (int axis = 0; axis < 3; ++axis) {
    const glm::dvec3 tip = origin + length_mm * pose.camera_from_object.rotation[axis];
    if (!inFront(tip)) continue;
    const cv::Scalar& colour = kAxisColours[static_cast<std::size_t>(axis)];
    const cv::Point from = fixedPoint(camera.project(origin));
    const cv::Point to = fixedPoint(camera.project(tip));
    cv::line(picture, from, to, cv::Scalar(0, 0, 0), 5, cv::LINE_AA, kShift);
    cv::line(picture, from, to, colour, 2, cv::LINE_AA, kShift);
    cv::circle(picture, to, 3 << kShift, colour, -1, cv::LINE_AA, kShift);
  }
}

PixelBox projectedBox(const OverlayPose& pose, const Camera& camera) {
  const SurfaceWindow window = windowOf(pose, camera);
  const Image<SurfaceTexel> part =
      host::renderSurface(*pose.mesh, camera, pose.camera_from_object, window);
  PixelBox box{camera.width, camera.height, 0, 0};
  for (int y = 0; y < part.height(); ++y) {
    for (int x = 0; x < part.width(); ++x) {
      if (part.at(x, y).w <= 0.0f) continue;
      box.x0 = std::min(box.x0, window.x0 + x);
      box.y0 = std::min(box.y0, window.y0 + y);
      box.x1 = std::max(box.x1, window.x0 + x + 1);
      box.y1 = std::max(box.y1, window.y0 + y + 1);
    }
  }
  return box.empty() ? PixelBox{} : box;
}

}  // namespace rangepose::debug
