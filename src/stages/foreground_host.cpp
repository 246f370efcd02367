#include "stages/foreground_host.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "stages/dropouts_host.h"
#include "stages/foreground_core.h"
#include "stages/noise_host.h"
#include "stages/plane_draws.h"
#include "stages/simd.h"

namespace rangepose {

ForegroundOptions ForegroundTask::optionsAt(double noise_mm) const {
  ForegroundOptions at = options;
  at.tolerance_mm = toleranceAt(noise_mm, options.tolerance_mm, thin_mm);
  return at;
}

namespace host {
namespace {

constexpr int kRowsPerPiece = 16;

using Samples = std::vector<SurfaceSample>;

Samples sampled(const DepthImage& image, double part_mm) {
  const auto measured = std::count_if(
      image.depth_mm.begin(), image.depth_mm.end(), [](float depth) { return depth > 0.0f; });
  const int stride = sampleStride(static_cast<double>(measured));
  const auto read = [&](int u, int v) {
    return image.depth_mm.contains(u, v) ? static_cast<double>(image.depth_mm.at(u, v)) : 0.0;
  };
  Samples samples;
  for (int v = 0; v < image.depth_mm.height(); v += stride) {
    for (int u = 0; u < image.depth_mm.width(); u += stride) {
      if (image.depth_mm.at(u, v) > 0.0f)
        samples.push_back(sampleAt(image.camera, read, u, v, part_mm));
    }
  }
  return samples;
}

/// Some of the samples, number by number: planes are tried on them in vectors.
struct TrialSamples {
  std::vector<double> x, y, z;     ///< points [mm]
  std::vector<double> nx, ny, nz;  ///< normals

  explicit TrialSamples(const Samples& samples) {
    const auto stride = static_cast<std::size_t>(trialStride(static_cast<int>(samples.size())));
    for (std::size_t i = 0; i < samples.size(); i += stride) {
      const SurfaceSample& sample = samples[i];
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
  for (const SurfaceSample& sample : samples) {
    if (!liesOn(sample, plane, tolerance)) continue;
    scatter.mean += sample.point;
    ++scatter.count;
  }
  if (scatter.count == 0) return scatter;
  scatter.mean /= static_cast<double>(scatter.count);
  for (const SurfaceSample& sample : samples) {
    if (!liesOn(sample, plane, tolerance)) continue;
    const glm::dvec3 d = sample.point - scatter.mean;
    scatter.covariance += glm::outerProduct(d, d);
  }
  scatter.covariance /= static_cast<double>(scatter.count);
  return scatter;
}

/// The plane through three random samples that most samples lie on, fitted to them; walls stand on
/// `floor`.
BackgroundPlane bestPlane(const Samples& samples,
                          const BackgroundPlane* floor,
                          bool orthographic,
                          double tolerance,
                          double max_behind,
                          PlaneDraws& draws) {
  const TrialSamples tried(samples);
  BackgroundPlane best;
  int best_count = 0;
  for (int trial = 0; trial < kPlaneTrials; ++trial) {
    SurfaceSample three[3];
    for (SurfaceSample& sample : three)
      sample = samples[static_cast<std::size_t>(draws.next() % samples.size())];
    BackgroundPlane plane;
    if (!planeThrough(three, orthographic, tolerance, floor, plane)) continue;
    const int count = countOn(tried, plane, tolerance, max_behind / tried.one_of, best_count);
    if (count > best_count) {
      best_count = count;
      best = plane;
    }
  }
  for (int round = 0; round < kPlaneFits && best_count > 0; ++round) {
    const Scatter scatter = scatterOn(samples, best, tolerance);
    if (scatter.count < 3) break;
    best = facingCamera(thinDirection(scatter.covariance, best.normal), scatter.mean, orthographic);
  }
  return best;
}

}  // namespace

std::vector<BackgroundPlane> findBackground(const DepthImage& image,
                                            const ForegroundOptions& options) {
  Samples rest = sampled(image, options.part_mm);
  const double total = static_cast<double>(rest.size());
  std::vector<BackgroundPlane> planes;
  PlaneDraws draws;
  while (static_cast<int>(planes.size()) < options.max_planes && rest.size() > kFewestSamples) {
    const bool is_floor = planes.empty();
    const BackgroundPlane plane = bestPlane(rest,
                                            is_floor ? nullptr : &planes.front(),
                                            image.camera.orthographic,
                                            options.tolerance_mm,
                                            options.max_behind * total,
                                            draws);
    const Scatter scatter = scatterOn(rest, plane, options.tolerance_mm);
    const PlaneKind kind =
        kindOf(scatter.covariance, plane.normal, scatter.count, total, is_floor, options);
    if (kind == PlaneKind::kNothing) break;
    if (kind == PlaneKind::kBackground) {
      const auto above = std::count_if(rest.begin(), rest.end(), [&](const SurfaceSample& sample) {
        return standsOut(sample, plane, options.tolerance_mm);
      });
      // A plane with nothing on it may be the parts themselves: flat ones, their table cut away.
      if (static_cast<double>(above) < options.min_above * total) break;
      planes.push_back(plane);
    }
    std::erase_if(rest, [&](const SurfaceSample& sample) {
      return !remains(sample, plane, kind, options.tolerance_mm);
    });
  }
  return planes;
}

Image<std::uint8_t> foregroundMask(const DepthImage& image,
                                   const std::vector<BackgroundPlane>& planes,
                                   const std::optional<BinBox>& bin,
                                   const ForegroundOptions& options) {
  Image<std::uint8_t> mask(image.depth_mm.width(), image.depth_mm.height(), 0);
  const BinRule in_bin = binRule(bin);
  parallelForEach(static_cast<std::size_t>(mask.height()), kRowsPerPiece, [&](std::size_t row) {
    const int v = static_cast<int>(row);
    for (int u = 0; u < mask.width(); ++u) {
      const double depth = image.depth_mm.at(u, v);
      if (depth > 0.0 && keeps(in_bin,
                               planes.data(),
                               static_cast<int>(planes.size()),
                               options.tolerance_mm,
                               image.camera.unproject(u, v, depth)))
        mask.at(u, v) = 1;
    }
  });
  return mask;
}

LateralExtent extentOf(const DepthImage& image, const Image<std::uint8_t>& mask) {
  const Image<float>& depth_mm = image.depth_mm;
  std::vector<LateralExtent> rows(static_cast<std::size_t>(depth_mm.height()));
  parallelForEach(rows.size(), kRowsPerPiece, [&](std::size_t row) {
    const int v = static_cast<int>(row);
    for (int u = 0; u < depth_mm.width(); ++u) {
      const double depth = depth_mm.at(u, v);
      if (depth == 0.0 || (!mask.empty() && mask.at(u, v) == 0)) continue;
      rows[row].add(glm::dvec2(image.camera.unproject(u, v, depth)));
    }
  });
  LateralExtent extent;
  for (const LateralExtent& row : rows) {
    if (row.empty()) continue;
    extent.add(row.low);
    extent.add(row.high);
  }
  return extent;
}

Foreground foreground(const DepthImage& measured, const ForegroundTask& task) {
  Foreground found;
  const Image<std::uint8_t> everything(measured.depth_mm.width(), measured.depth_mm.height(), 1);
  found.noise_mm = depthNoise(measured, everything);
  found.depth = fillDropouts(measured, found.noise_mm);
  const ForegroundOptions options = task.optionsAt(found.noise_mm);
  found.background = findBackground(found.depth, options);
  found.mask = foregroundMask(found.depth, found.background, task.bin, options);
  return found;
}

}  // namespace host
}  // namespace rangepose
