// The depth image that a cloud stands for: projected, on its own grid, or seen by a made-up camera.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.h"
#include "io/camera_file.h"
#include "io/cloud_file.h"
#include "io/direction_spacing.h"

namespace rangepose {
namespace {

constexpr int kMaxMadeUpSide = 2048;
constexpr double kMaxTangent = 5.67;    // of 80 degrees
constexpr double kMaxResidualPx = 0.5;  // root mean square
constexpr int kMinFitPoints = 16;

bool isSeen(const glm::vec3& point) {
  return std::isfinite(point.x) && std::isfinite(point.y) && std::isfinite(point.z) &&
         point.z > 0.0f;
}

DepthImage projected(const PointCloud& cloud, const Camera& camera) {
  DepthImage image{camera, Image<float>(camera.width, camera.height)};
  for (const glm::vec3& point : cloud.points_mm) {
    if (!isSeen(point)) continue;
    const glm::dvec2 pixel = camera.project(point);
    if (!(pixel.x >= -0.5 && pixel.x < camera.width - 0.5)) continue;
    if (!(pixel.y >= -0.5 && pixel.y < camera.height - 0.5)) continue;
    float& depth = image.depth_mm.at(static_cast<int>(std::floor(pixel.x + 0.5)),
                                     static_cast<int>(std::floor(pixel.y + 0.5)));
    if (depth == 0.0f || point.z < depth) depth = point.z;
  }
  return image;
}

/// The line pixel = slope * tangent + offset through all pairs, by least squares.
class LineFit {
 public:
  void add(double tangent, double pixel) {
    count_ += 1.0;
    sum_t_ += tangent;
    sum_p_ += pixel;
    sum_tt_ += tangent * tangent;
    sum_tp_ += tangent * pixel;
    sum_pp_ += pixel * pixel;
  }
  /// False when the pairs do not determine a line, or lie more than half a pixel beside it.
  bool solve(double& slope, double& offset) const {
    const double var_t = sum_tt_ - sum_t_ * sum_t_ / count_;
    const double cov = sum_tp_ - sum_t_ * sum_p_ / count_;
    const double var_p = sum_pp_ - sum_p_ * sum_p_ / count_;
    if (count_ < kMinFitPoints || !(var_t > 1e-12 * count_) || !(cov > 0.0)) return false;
    slope = cov / var_t;
    offset = (sum_p_ - slope * sum_t_) / count_;
    return (var_p - slope * cov) / count_ <= kMaxResidualPx * kMaxResidualPx;
  }

 private:
  double count_ = 0.0;
  double sum_t_ = 0.0;
  double sum_p_ = 0.0;
  double sum_tt_ = 0.0;
  double sum_tp_ = 0.0;
  double sum_pp_ = 0.0;
};

/// The pinhole camera of an organised cloud, and its z as the image.
std::optional<DepthImage> onOwnGrid(const PointCloud& cloud) {
  DepthImage image;
  image.camera.width = cloud.width;
  image.camera.height = cloud.height;
  image.depth_mm = Image<float>(cloud.width, cloud.height);
  LineFit columns;
  LineFit rows;
  for (int v = 0; v < cloud.height; ++v) {
    for (int u = 0; u < cloud.width; ++u) {
      const auto index = static_cast<std::size_t>(v) * static_cast<std::size_t>(cloud.width) +
                         static_cast<std::size_t>(u);
      const glm::dvec3 point = cloud.points_mm[index];
      if (!isSeen(cloud.points_mm[index])) continue;
      columns.add(point.x / point.z, u);
      rows.add(point.y / point.z, v);
      image.depth_mm.at(u, v) = cloud.points_mm[index].z;
    }
  }
  Camera& camera = image.camera;
  if (!columns.solve(camera.fx, camera.cx) || !rows.solve(camera.fy, camera.cy))
    return std::nullopt;
  return image;
}

DepthImage fromMadeUpCamera(const PointCloud& cloud) {
  std::vector<glm::dvec2> tangents;
  glm::dvec2 low{std::numeric_limits<double>::max()};
  glm::dvec2 high{std::numeric_limits<double>::lowest()};
  for (const glm::vec3& point : cloud.points_mm) {
    if (!isSeen(point)) continue;
    const glm::dvec2 tangent = glm::dvec2(point.x, point.y) / static_cast<double>(point.z);
    if (!(std::max(std::abs(tangent.x), std::abs(tangent.y)) <= kMaxTangent)) continue;
    tangents.push_back(tangent);
    low = glm::min(low, tangent);
    high = glm::max(high, tangent);
  }
  if (tangents.empty()) {
    throw Error("cloud: no point lies in front of the camera (z > 0); check its frame");
  }
  const double extent = std::max(high.x - low.x, high.y - low.y);
  const double spacing = std::max(typicalSpacing(tangents), extent / (kMaxMadeUpSide - 2));
  Camera camera;
  camera.fx = spacing > 0.0 ? 1.0 / spacing : 1.0;
  camera.fy = camera.fx;
  camera.cx = -low.x * camera.fx;
  camera.cy = -low.y * camera.fy;
  camera.width = static_cast<int>(std::floor((high.x - low.x) * camera.fx + 0.5)) + 1;
  camera.height = static_cast<int>(std::floor((high.y - low.y) * camera.fy + 0.5)) + 1;
  DepthImage image = projected(cloud, camera);
  return image;
}

/// The camera with a size of its own or that of an organised cloud.
Camera sizedCamera(const PointCloud& cloud, const Camera& camera) {
  if (camera.width == 0 && cloud.height == 1) {
    throw Error(
        "camera file: fields \"width\" and \"height\" are needed for a cloud without a grid");
  }
  const bool own_size = camera.width != 0;
  return withImageSize(camera,
                       own_size ? camera.width : cloud.width,
                       own_size ? camera.height : cloud.height,
                       "camera of the cloud");
}

}  // namespace

DepthImage depthFromCloud(const PointCloud& cloud, const std::optional<Camera>& camera) {
  RP_CHECK(
      cloud.width >= 0 && cloud.height >= 0 &&
          cloud.points_mm.size() ==
              static_cast<std::size_t>(cloud.width) * static_cast<std::size_t>(cloud.height),
      fmt::format(
          "cloud: {} points are not {}x{}", cloud.points_mm.size(), cloud.width, cloud.height));
  if (camera) return projected(cloud, sizedCamera(cloud, *camera));
  if (cloud.height > 1 && cloud.width > 1) {
    if (std::optional<DepthImage> image = onOwnGrid(cloud)) return *image;
  }
  return fromMadeUpCamera(cloud);
}

}  // namespace rangepose
