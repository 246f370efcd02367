#include "debug/relief.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "core/parallel.h"

namespace rangepose::debug {
namespace {

/// A neighbour farther away than this many times the spacing of the pixels is another surface.
constexpr float kJumpInSpacings = 6.0f;

struct Smoothed {
  Image<float> depth_mm;
  float near_mm = 0.0f;
  float far_mm = 1.0f;
  float jump_mm = 1.0f;
};

/// Noise is taken out for the shading only: normals of raw depths look like gravel.
Smoothed smoothed(const DepthImage& image) {
  Smoothed result{image.depth_mm, 0.0f, 1.0f, 1.0f};
  std::vector<float> present;
  for (const float z : image.depth_mm) {
    if (z > 0.0f) present.push_back(z);
  }
  if (present.empty()) return result;
  const auto quantile = [&](double share) {
    const auto rank = static_cast<std::ptrdiff_t>(share * static_cast<double>(present.size() - 1));
    std::nth_element(present.begin(), present.begin() + rank, present.end());
    return present[static_cast<std::size_t>(rank)];
  };
  result.near_mm = quantile(0.02);
  result.far_mm = std::max(quantile(0.98), result.near_mm + 1e-3f);
  const double spacing = image.camera.pixelSpacingMm(quantile(0.5));
  result.jump_mm = kJumpInSpacings * static_cast<float>(spacing);
  const cv::Mat raw(image.depth_mm.height(),
                    image.depth_mm.width(),
                    CV_32F,
                    const_cast<float*>(image.depth_mm.data()));  // read only below
  cv::Mat filtered(raw.size(), CV_32F, result.depth_mm.data());
  cv::bilateralFilter(raw, filtered, 5, 0.5 * static_cast<double>(result.jump_mm), 2.0);
  for (std::size_t i = 0; i < image.depth_mm.size(); ++i) {
    if (image.depth_mm.data()[i] == 0.0f) result.depth_mm.data()[i] = 0.0f;
  }
  return result;
}

/// Difference of the surface between the two neighbours along one axis, on the same surface only.
bool tangent(
    const Smoothed& depth, const Camera& camera, int x, int y, int dx, int dy, glm::dvec3& out) {
  const float z = depth.depth_mm.at(x, y);
  const auto usable = [&](int nx, int ny) {
    if (!depth.depth_mm.contains(nx, ny)) return false;
    const float other = depth.depth_mm.at(nx, ny);
    return other > 0.0f && std::abs(other - z) < depth.jump_mm;
  };
  const bool after = usable(x + dx, y + dy);
  const bool before = usable(x - dx, y - dy);
  if (!after && !before) return false;
  const int ax = after ? x + dx : x;
  const int ay = after ? y + dy : y;
  const int bx = before ? x - dx : x;
  const int by = before ? y - dy : y;
  out = camera.unproject(ax, ay, depth.depth_mm.at(ax, ay)) -
        camera.unproject(bx, by, depth.depth_mm.at(bx, by));
  return true;
}

/// Whether a neighbour is so much nearer that it casts its outline on this pixel.
bool behindStep(const Smoothed& depth, int x, int y) {
  const float z = depth.depth_mm.at(x, y);
  for (int k = 0; k < 4; ++k) {
    const int nx = x + (k == 0) - (k == 1);
    const int ny = y + (k == 2) - (k == 3);
    if (!depth.depth_mm.contains(nx, ny)) continue;
    const float other = depth.depth_mm.at(nx, ny);
    if (other > 0.0f && z - other > depth.jump_mm) return true;
  }
  return false;
}

unsigned char grey(const Smoothed& depth, const Camera& camera, int x, int y) {
  static const glm::dvec3 kToLight = glm::normalize(glm::dvec3(-1.0, -1.2, -1.3));
  glm::dvec3 along_x;
  glm::dvec3 along_y;
  double lit = 0.5;
  if (tangent(depth, camera, x, y, 1, 0, along_x) && tangent(depth, camera, x, y, 0, 1, along_y)) {
    const glm::dvec3 normal = glm::normalize(glm::cross(along_y, along_x));
    lit = 0.18 + 0.82 * std::max(0.0, glm::dot(normal, kToLight));
  }
  const double z = depth.depth_mm.at(x, y);
  const double away = std::clamp((z - depth.near_mm) / (depth.far_mm - depth.near_mm), 0.0, 1.0);
  double value = 250.0 * lit * (1.0 - 0.3 * away);
  if (behindStep(depth, x, y)) value *= 0.45;
  return cv::saturate_cast<unsigned char>(value);
}

}  // namespace

cv::Mat relief(const DepthImage& image) {
  const Smoothed depth = smoothed(image);
  cv::Mat pixels(image.depth_mm.height(), image.depth_mm.width(), CV_8UC3, cv::Scalar(kHoleColour));
  parallelFor(image.depth_mm.height(), 16, [&](int begin, int end) {
    for (int y = begin; y < end; ++y) {
      for (int x = 0; x < image.depth_mm.width(); ++x) {
        if (image.depth_mm.at(x, y) <= 0.0f) continue;
        const unsigned char value = grey(depth, image.camera, x, y);
        pixels.at<cv::Vec3b>(y, x) = {value, value, value};
      }
    }
  });
  return pixels;
}

int PictureView::sourceX(int x) const {
  const int u = static_cast<int>(std::floor(source.x0 + (x + 0.5) / scale));
  return std::clamp(u, source.x0, source.x1 - 1);
}

int PictureView::sourceY(int y) const {
  const int v = static_cast<int>(std::floor(source.y0 + (y + 0.5) / scale));
  return std::clamp(v, source.y0, source.y1 - 1);
}

cv::Point2d PictureView::pictureFrom(double u, double v) const {
  return {(u - source.x0 + 0.5) * scale - 0.5, (v - source.y0 + 0.5) * scale - 0.5};
}

Camera PictureView::camera(const Camera& depth_camera) const {
  Camera result = depth_camera;
  const cv::Point2d principal = pictureFrom(depth_camera.cx, depth_camera.cy);
  result.width = width;
  result.height = height;
  result.cx = principal.x;
  result.cy = principal.y;
  result.fx = depth_camera.fx * scale;
  result.fy = depth_camera.fy * scale;
  result.pixel_size_mm = depth_camera.pixel_size_mm / scale;
  return result;
}

PictureView pictureView(const PixelBox& source, double scale) {
  const auto length = [&](int pixels) {
    return std::max(1, static_cast<int>(std::lround(pixels * scale)));
  };
  return {source, scale, length(source.width()), length(source.height())};
}

cv::Mat shown(const cv::Mat& pixels, const PictureView& view) {
  cv::Mat picture(view.height, view.width, pixels.type());
  for (int y = 0; y < view.height; ++y) {
    const cv::Vec3b* from = pixels.ptr<cv::Vec3b>(view.sourceY(y));
    cv::Vec3b* to = picture.ptr<cv::Vec3b>(y);
    for (int x = 0; x < view.width; ++x) to[x] = from[view.sourceX(x)];
  }
  return picture;
}

}  // namespace rangepose::debug
