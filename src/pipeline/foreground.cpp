#include "pipeline/foreground.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "core/parallel.h"
#include "stages/simd.h"

namespace rangepose {
namespace {

constexpr int kSamples = 12000;
constexpr int kTrialSamples = 1500;
constexpr int kTrials = 4000;
/// A wall makes at least this angle with the floor: cos 50 degrees.
constexpr double kMaxWallCos = 0.64;
/// Points of a part's face that is hidden in the middle are spread wider than the face's area.
constexpr double kFaceInParts = 1.35;

/// A measured point with the slope of the surface there.
struct Sample {
  glm::dvec3 point;
  glm::dvec3 normal;  ///< towards the camera
};
using Samples = std::vector<Sample>;

/// Slope from the points `reach` pixels to either side.
bool surfaceNormal(const DepthImage& image, int u, int v, int reach, glm::dvec3& normal) {
  const auto depth = [&](int x, int y) {
    return image.depth_mm.contains(x, y) ? static_cast<double>(image.depth_mm.at(x, y)) : 0.0;
  };
  const double left = depth(u - reach, v);
  const double right = depth(u + reach, v);
  const double up = depth(u, v - reach);
  const double down = depth(u, v + reach);
  if (left == 0.0 || right == 0.0 || up == 0.0 || down == 0.0) return false;
  const glm::dvec3 x =
      image.camera.unproject(u + reach, v, right) - image.camera.unproject(u - reach, v, left);
  const glm::dvec3 y =
      image.camera.unproject(u, v + reach, down) - image.camera.unproject(u, v - reach, up);
  normal = glm::normalize(glm::cross(y, x));
  return true;
}

Samples sampled(const DepthImage& image, double part_mm) {
  const auto measured = std::count_if(
      image.depth_mm.begin(), image.depth_mm.end(), [](float depth) { return depth > 0.0f; });
  const int stride =
      std::max(1, static_cast<int>(std::sqrt(static_cast<double>(measured) / kSamples)));
  Samples samples;
  for (int v = 0; v < image.depth_mm.height(); v += stride) {
    for (int u = 0; u < image.depth_mm.width(); u += stride) {
      const double depth = image.depth_mm.at(u, v);
      if (!(depth > 0.0)) continue;
      const int reach =
          std::clamp(static_cast<int>(0.05 * part_mm / image.camera.pixelSpacingMm(depth)), 2, 20);
      glm::dvec3 normal(0.0);
      surfaceNormal(image, u, v, reach, normal);
      samples.push_back({image.camera.unproject(u, v, depth), normal});
    }
  }
  return samples;
}

BackgroundPlane facingCamera(glm::dvec3 normal, const glm::dvec3& point, bool orthographic) {
  const double towards = orthographic ? -normal.z : -glm::dot(normal, point);
  if (towards < 0.0) normal = -normal;
  return {normal, glm::dot(normal, point)};
}

/// Near it and sloped like it: a plane that cuts through a heap has as many points near it as a
/// floor, but not their slope.
bool liesOn(const Sample& sample, const BackgroundPlane& plane, double tolerance) {
  return std::abs(plane.heightOf(sample.point)) <= tolerance &&
         glm::dot(sample.normal, plane.normal) > kFlatTiltCos;
}

/// Some of the samples, number by number: planes are tried on them in vectors.
struct TrialSamples {
  std::vector<double> x, y, z;     ///< points [mm]
  std::vector<double> nx, ny, nz;  ///< normals

  explicit TrialSamples(const Samples& samples) {
    const std::size_t stride = std::max<std::size_t>(1, samples.size() / kTrialSamples);
    for (std::size_t i = 0; i < samples.size(); i += stride) {
      const Sample& sample = samples[i];
      x.push_back(sample.point.x);
      y.push_back(sample.point.y);
      z.push_back(sample.point.z);
      nx.push_back(sample.normal.x);
      ny.push_back(sample.normal.y);
      nz.push_back(sample.normal.z);
    }
    one_of = static_cast<double>(stride);
  }
  std::size_t size() const { return x.size(); }

  double one_of;  ///< so many samples
};

/// Number of samples on the plane; 0 when more than `max_behind` lie behind it: then it is no
/// background. Also 0 when it is not more than `best`.
RP_SIMD_CLONES int countOn(const TrialSamples& samples,
                           const BackgroundPlane& plane,
                           double tolerance,
                           double max_behind,
                           int best) {
  constexpr std::size_t kBlock = 128;
  const glm::dvec3 n = plane.normal;
  std::int64_t count = 0;
  std::int64_t behind = 0;
  for (std::size_t begin = 0; begin < samples.size(); begin += kBlock) {
    const std::size_t end = std::min(begin + kBlock, samples.size());
    if (count + static_cast<std::int64_t>(samples.size() - begin) <= best) return 0;
    for (std::size_t i = begin; i < end; ++i) {
      const double height =
          n.x * samples.x[i] + n.y * samples.y[i] + n.z * samples.z[i] - plane.offset_mm;
      const double cosine = n.x * samples.nx[i] + n.y * samples.ny[i] + n.z * samples.nz[i];
      const bool near = std::abs(height) <= tolerance;
      const bool flat = cosine > kFlatTiltCos;
      count += near & flat ? 1 : 0;
      behind += height < -3.0 * tolerance ? 1 : 0;
    }
    if (static_cast<double>(behind) > max_behind) return 0;
  }
  return static_cast<int>(count);
}

/// Mean and scatter of the points on a plane.
struct Scatter {
  glm::dvec3 mean{0.0};
  glm::dmat3 covariance{0.0};
  int count = 0;
};

Scatter scatterOn(const Samples& samples, const BackgroundPlane& plane, double tolerance) {
  Scatter scatter;
  for (const Sample& sample : samples) {
    if (!liesOn(sample, plane, tolerance)) continue;
    scatter.mean += sample.point;
    ++scatter.count;
  }
  if (scatter.count == 0) return scatter;
  scatter.mean /= static_cast<double>(scatter.count);
  for (const Sample& sample : samples) {
    if (!liesOn(sample, plane, tolerance)) continue;
    const glm::dvec3 d = sample.point - scatter.mean;
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

bool fitsFace(const PlaneExtent& extent, const PlaneExtent& face) {
  return extent.length_mm < kFaceInParts * face.length_mm &&
         extent.width_mm < kFaceInParts * face.width_mm;
}

/// The plane through three random samples that most samples lie on, fitted to them; walls stand on
/// `floor`.
BackgroundPlane bestPlane(const Samples& samples,
                          const BackgroundPlane* floor,
                          bool orthographic,
                          double tolerance,
                          double max_behind,
                          std::mt19937_64& random) {
  const TrialSamples tried(samples);
  const auto pick = [&]() -> const Sample& {
    return samples[static_cast<std::size_t>(random() % samples.size())];
  };
  BackgroundPlane best;
  int best_count = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    const Sample& a = pick();
    const Sample& b = pick();
    const Sample& c = pick();
    const glm::dvec3 normal = glm::cross(b.point - a.point, c.point - a.point);
    const double length = glm::length(normal);
    if (length < 1e-9) continue;
    const BackgroundPlane plane = facingCamera(normal / length, a.point, orthographic);
    // Most triples lie on several surfaces: their slopes give them away before anything is counted.
    if (!liesOn(a, plane, tolerance) || !liesOn(b, plane, tolerance) ||
        !liesOn(c, plane, tolerance))
      continue;
    if (floor != nullptr && std::abs(glm::dot(plane.normal, floor->normal)) > kMaxWallCos) continue;
    const int count = countOn(tried, plane, tolerance, max_behind / tried.one_of, best_count);
    if (count > best_count) {
      best_count = count;
      best = plane;
    }
  }
  for (int round = 0; round < 3 && best_count > 0; ++round) {
    const Scatter scatter = scatterOn(samples, best, tolerance);
    if (scatter.count < 3) break;
    best = facingCamera(thinDirection(scatter, best.normal), scatter.mean, orthographic);
  }
  return best;
}

}  // namespace

ForegroundOptions foregroundOptionsFor(const ReferenceDatabase& database, double noise_mm) {
  ForegroundOptions options;
  options.part_mm = 0.0;
  for (const ReferenceObject& object : database.objects) {
    options.part_mm = std::max(options.part_mm, object.diameter_mm);
    PlaneExtent& face = options.flat_face;
    face.length_mm = std::max(face.length_mm, object.flat_face.length_mm);
    face.width_mm = std::max(face.width_mm, object.flat_face.width_mm);
  }
  const double coarse_mm = std::max(1.5, 0.02 * options.part_mm);
  // A thin part must not go with the table that it lies on, as far as the noise allows.
  const double least_mm = std::min(coarse_mm, 3.0 * noise_mm);
  options.tolerance_mm = coarse_mm;
  for (const ReferenceObject& object : database.objects) {
    const double finer_mm = object.finerIfThin(coarse_mm);
    options.tolerance_mm = std::min(options.tolerance_mm, std::max(finer_mm, least_mm));
  }
  return options;
}

std::vector<BackgroundPlane> findBackground(const DepthImage& image,
                                            const ForegroundOptions& options) {
  Samples rest = sampled(image, options.part_mm);
  const double total = static_cast<double>(rest.size());
  std::vector<BackgroundPlane> planes;
  std::mt19937_64 random(20100);
  while (static_cast<int>(planes.size()) < options.max_planes && rest.size() > 50) {
    const bool is_floor = planes.empty();
    const BackgroundPlane plane = bestPlane(rest,
                                            is_floor ? nullptr : &planes.front(),
                                            image.camera.orthographic,
                                            options.tolerance_mm,
                                            options.max_behind * total,
                                            random);
    const Scatter scatter = scatterOn(rest, plane, options.tolerance_mm);
    if (scatter.count < total * (is_floor ? options.min_floor_share : options.min_wall_share))
      break;
    const PlaneExtent extent = extentInPlane(scatter.covariance, plane.normal);
    if (fitsFace(extent, options.flat_face)) {
      // A sheet with nothing behind it. It is no floor either, so that walls are looked for beside.
      std::erase_if(rest,
                    [&](const Sample& one) { return liesOn(one, plane, options.tolerance_mm); });
      continue;
    }
    const double scale = options.part_mm;
    if (extent.length_mm < (is_floor ? 1.3 : 0.7) * scale) break;
    if (extent.width_mm < (is_floor ? 0.4 : 0.25) * scale) break;
    const auto above = std::count_if(rest.begin(), rest.end(), [&](const Sample& sample) {
      return plane.heightOf(sample.point) > 3.0 * options.tolerance_mm;
    });
    // A plane with nothing on it may be the parts themselves: flat ones, their table cut away.
    if (static_cast<double>(above) < options.min_above * total) break;
    planes.push_back(plane);
    std::erase_if(rest, [&](const Sample& sample) {
      return plane.heightOf(sample.point) <= 1.5 * options.tolerance_mm;
    });
  }
  return planes;
}

Image<std::uint8_t> foregroundMask(const DepthImage& image,
                                   const std::vector<BackgroundPlane>& planes,
                                   const std::optional<BinBox>& bin,
                                   const ForegroundOptions& options) {
  Image<std::uint8_t> mask(image.depth_mm.width(), image.depth_mm.height(), 0);
  constexpr int kRowsPerPiece = 16;
  const double margin = 1.5 * options.tolerance_mm;
  const Pose bin_from_camera = bin ? bin->camera_from_bin.inverse() : Pose{};
  const auto isKept = [&](const glm::dvec3& point) {
    const bool above = std::all_of(planes.begin(), planes.end(), [&](const BackgroundPlane& plane) {
      return plane.heightOf(point) > margin;
    });
    if (!above || !bin) return above;
    const glm::dvec3 inside = bin_from_camera * point;
    return std::abs(inside.x) < 0.5 * bin->inner_size_mm.x - margin &&
           std::abs(inside.y) < 0.5 * bin->inner_size_mm.y - margin && inside.z > margin;
  };
  parallelForEach(static_cast<std::size_t>(mask.height()), kRowsPerPiece, [&](std::size_t row) {
    const int v = static_cast<int>(row);
    for (int u = 0; u < mask.width(); ++u) {
      const double depth = image.depth_mm.at(u, v);
      if (depth > 0.0 && isKept(image.camera.unproject(u, v, depth))) mask.at(u, v) = 1;
    }
  });
  return mask;
}

}  // namespace rangepose
