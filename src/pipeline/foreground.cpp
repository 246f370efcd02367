#include "pipeline/foreground.h"

#include <algorithm>
#include <cmath>
#include <random>


namespace rangepose {
namespace {

constexpr int kSamples = 12000;
constexpr int kTrialSamples = 1500;
constexpr int kTrials = 500;
/// A wall makes at least this angle with the floor: cos 50 degrees.
constexpr double kMaxWallCos = 0.64;

using Points = std::vector<glm::dvec3>;

Points sampled(const DepthImage& image) {
  const auto measured = std::count_if(
      image.depth_mm.begin(), image.depth_mm.end(), [](float depth) { return depth > 0.0f; });
  const int stride = std::max(1, static_cast<int>(std::sqrt(static_cast<double>(measured) / kSamples)));
  Points points;
  for (int v = 0; v < image.depth_mm.height(); v += stride) {
    for (int u = 0; u < image.depth_mm.width(); u += stride) {
      const double depth = image.depth_mm.at(u, v);
      if (depth > 0.0) points.push_back(image.camera.unproject(u, v, depth));
    }
  }
  return points;
}

BackgroundPlane facingCamera(glm::dvec3 normal, const glm::dvec3& point, bool orthographic) {
  const double towards = orthographic ? -normal.z : -glm::dot(normal, point);
  if (towards < 0.0) normal = -normal;
  return {normal, glm::dot(normal, point)};
}

int countNear(const Points& points, const BackgroundPlane& plane, double tolerance, std::size_t stride) {
  int count = 0;
  for (std::size_t i = 0; i < points.size(); i += stride) {
    count += std::abs(plane.heightOf(points[i])) <= tolerance ? 1 : 0;
  }
  return count;
}

/// Mean and scatter of the points near a plane.
struct Scatter {
  glm::dvec3 mean{0.0};
  glm::dmat3 covariance{0.0};
  int count = 0;
};

Scatter scatterNear(const Points& points, const BackgroundPlane& plane, double tolerance) {
  Scatter scatter;
  for (const glm::dvec3& point : points) {
    if (std::abs(plane.heightOf(point)) > tolerance) continue;
    scatter.mean += point;
    ++scatter.count;
  }
  if (scatter.count == 0) return scatter;
  scatter.mean /= static_cast<double>(scatter.count);
  for (const glm::dvec3& point : points) {
    if (std::abs(plane.heightOf(point)) > tolerance) continue;
    const glm::dvec3 d = point - scatter.mean;
    scatter.covariance += glm::outerProduct(d, d);
  }
  scatter.covariance /= static_cast<double>(scatter.count);
  return scatter;
}

/// The direction in which the points scatter least, by inverse iteration from the old normal.
glm::dvec3 thinDirection(const Scatter& scatter, glm::dvec3 normal) {
  const double trace =
      scatter.covariance[0][0] + scatter.covariance[1][1] + scatter.covariance[2][2];
  const glm::dmat3 inverse = glm::inverse(scatter.covariance + glm::dmat3(1e-9 * trace + 1e-12));
  for (int i = 0; i < 8; ++i) normal = glm::normalize(inverse * normal);
  return normal;
}

/// Width of the points across the plane in its narrow direction, as if spread evenly [mm].
double narrowExtent(const Scatter& scatter, const glm::dvec3& normal) {
  const glm::dvec3 helper = std::abs(normal.x) < 0.9 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 a = glm::normalize(glm::cross(normal, helper));
  const glm::dvec3 b = glm::cross(normal, a);
  const double aa = glm::dot(a, scatter.covariance * a);
  const double ab = glm::dot(a, scatter.covariance * b);
  const double bb = glm::dot(b, scatter.covariance * b);
  const double spread = std::sqrt(std::max(0.0, 0.25 * (aa - bb) * (aa - bb) + ab * ab));
  return std::sqrt(12.0 * std::max(0.0, 0.5 * (aa + bb) - spread));
}

/// The plane through three random points that most points lie on, fitted to them; wall candidates stand
/// on `floor`.
BackgroundPlane bestPlane(const Points& points,
                          const BackgroundPlane* floor,
                          bool orthographic,
                          double tolerance,
                          std::mt19937_64& random) {
  const std::size_t stride = std::max<std::size_t>(1, points.size() / kTrialSamples);
  const auto pick = [&](std::size_t around, std::size_t reach) {
    const std::size_t low = around > reach ? around - reach : 0;
    const std::size_t high = std::min(points.size() - 1, around + reach);
    return low + static_cast<std::size_t>(random() % (high - low + 1));
  };
  BackgroundPlane best;
  int best_count = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    // Points of neighbouring rows are near each other: half of the triples are local, so that a floor
    // of which little is seen has a chance.
    const std::size_t reach = trial % 2 == 0 ? points.size() : points.size() / 12 + 3;
    const std::size_t i = pick(0, points.size());
    const glm::dvec3& a = points[i];
    const glm::dvec3 normal = glm::cross(points[pick(i, reach)] - a, points[pick(i, reach)] - a);
    const double length = glm::length(normal);
    if (length < 1e-9) continue;
    const BackgroundPlane plane = facingCamera(normal / length, a, orthographic);
    if (floor != nullptr && std::abs(glm::dot(plane.normal, floor->normal)) > kMaxWallCos) continue;
    const int count = countNear(points, plane, tolerance, stride);
    if (count > best_count) {
      best_count = count;
      best = plane;
    }
  }
  for (int round = 0; round < 3 && best_count > 0; ++round) {
    const Scatter scatter = scatterNear(points, best, tolerance);
    if (scatter.count < 3) break;
    best = facingCamera(thinDirection(scatter, best.normal), scatter.mean, orthographic);
  }
  return best;
}

double shareBehind(const Points& points, const BackgroundPlane& plane, double tolerance) {
  const auto behind = std::count_if(points.begin(), points.end(), [&](const glm::dvec3& point) {
    return plane.heightOf(point) < -tolerance;
  });
  return static_cast<double>(behind) / static_cast<double>(points.size());
}

}  // namespace

std::vector<BackgroundPlane> findBackground(const DepthImage& image, const ForegroundOptions& options) {
  const Points all = sampled(image);
  std::vector<BackgroundPlane> planes;
  Points rest = all;
  std::mt19937_64 random(20100);
  const double total = static_cast<double>(all.size());
  while (static_cast<int>(planes.size()) < options.max_planes && rest.size() > 50) {
    const bool is_floor = planes.empty();
    const BackgroundPlane plane = bestPlane(rest, is_floor ? nullptr : &planes.front(),
                                            image.camera.orthographic, options.tolerance_mm, random);
    const Scatter scatter = scatterNear(rest, plane, options.tolerance_mm);
    const double share = scatter.count / total;
    if (share < (is_floor ? options.min_floor_share : options.min_wall_share)) break;
    const double min_extent = (is_floor ? 1.2 : 0.3) * options.part_mm;
    const bool large = narrowExtent(scatter, plane.normal) >= min_extent;
    const bool last = shareBehind(rest, plane, 3.0 * options.tolerance_mm) * static_cast<double>(rest.size()) <=
                      options.max_behind * total;
    if (!large || !last) break;
    planes.push_back(plane);
    std::erase_if(rest, [&](const glm::dvec3& point) {
      return plane.heightOf(point) <= 1.5 * options.tolerance_mm;
    });
  }
  return planes;
}

Image<std::uint8_t> foregroundMask(const DepthImage& image,
                                   const std::vector<BackgroundPlane>& planes,
                                   const std::optional<BinBox>& bin,
                                   const ForegroundOptions& options) {
  Image<std::uint8_t> mask(image.depth_mm.width(), image.depth_mm.height(), 0);
  const double margin = 1.5 * options.tolerance_mm;
  const Pose bin_from_camera = bin ? bin->camera_from_bin.inverse() : Pose{};
  for (int v = 0; v < mask.height(); ++v) {
    for (int u = 0; u < mask.width(); ++u) {
      const double depth = image.depth_mm.at(u, v);
      if (!(depth > 0.0)) continue;
      const glm::dvec3 point = image.camera.unproject(u, v, depth);
      bool kept = std::all_of(planes.begin(), planes.end(), [&](const BackgroundPlane& plane) {
        return plane.heightOf(point) > margin;
      });
      if (kept && bin) {
        const glm::dvec3 inside = bin_from_camera * point;
        kept = std::abs(inside.x) < 0.5 * bin->inner_size_mm.x - margin &&
               std::abs(inside.y) < 0.5 * bin->inner_size_mm.y - margin && inside.z > margin;
      }
      mask.at(u, v) = kept ? 1 : 0;
    }
  }
  return mask;
}

}  // namespace rangepose
