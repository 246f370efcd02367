#include "eval/surface_errors.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/normal_equations.h"

namespace rangepose {
namespace {

/// Parts with fewer pixels are left out: six unknowns would explain most of their error.
constexpr std::size_t kLeastPixels = 200;
constexpr int kRounds = 5;
/// Of the squared step (both its halves in mm at the part's rim), as share of a pixel's weight:
/// what the pixels do not hold does not move.
constexpr double kDamping = 1e-3;
/// In the fit, pixels further off than this many deviations are left out; never nearer ones [mm].
constexpr double kTrim = 3.0;
constexpr double kLeastTrimMm = 0.1;
constexpr double kDeviationOfMedian = 1.4826;

/// Second differences are cut off at so many of their own deviations, round by round; where these
/// begin: the rms of the smallest 90 %, which is that of a normal distribution so cut off.
constexpr double kCut = 3.0;
constexpr int kCutRounds = 20;
constexpr double kFirstShare = 0.9;
/// rms of what is left of a normal distribution of deviation 1 that is cut off at +-t: sqrt(1 - 2 t
/// p(t) / share), for t = 3, and for the t that leaves 90 %.
constexpr double kCutRms = 0.986578;
constexpr double kFirstRms = 0.789313;

using Motion = NormalEquations<6>::Row;

/// A pixel of a part.
struct Sample {
  int u = 0;
  int v = 0;
  double error_mm = 0.0;
  double facing = 0.0;  ///< normal times ray of depth 1 mm, negative
  double cosine = 0.0;
  Motion moves{};  ///< along the normal, by each of the unknowns

  double rest(const Motion& motion) const {
    double moved = 0.0;
    for (std::size_t i = 0; i < motion.size(); ++i) moved += moves[i] * motion[i];
    return error_mm - moved / facing;
  }
  double off(const Motion& motion) const { return std::abs(rest(motion)) * cosine; }
};

/// Those of each part that may be compared.
std::vector<std::vector<Sample>> samplesOf(const DepthImage& image,
                                           const KnownSurface& known,
                                           const std::vector<KnownPart>& parts) {
  std::vector<std::vector<Sample>> samples(parts.size());
  for (int v = 0; v < known.height(); ++v) {
    for (int u = 0; u < known.width(); ++u) {
      const KnownPixel& pixel = known.at(u, v);
      const double measured = image.depth_mm.at(u, v);
      if (!pixel.inner() || measured == 0.0 || pixel.cosine < kLeastErrorCosine) continue;
      const auto part = static_cast<std::size_t>(pixel.part);
      if (!parts[part].counted) continue;
      Sample sample{u, v, measured - pixel.depth_mm, 0.0, pixel.cosine, {}};
      sample.facing = glm::dot(glm::dvec3(pixel.normal), rayOf(image.camera, u, v));
      samples[part].push_back(sample);
    }
  }
  return samples;
}

void fillMoves(std::vector<Sample>& samples,
               const KnownSurface& known,
               const Camera& camera,
               double radius_mm) {
  const auto point = [&](const Sample& sample) {
    return camera.unproject(sample.u, sample.v, known.at(sample.u, sample.v).depth_mm);
  };
  glm::dvec3 middle(0.0);
  for (const Sample& sample : samples) middle += point(sample);
  middle /= static_cast<double>(samples.size());
  for (Sample& sample : samples) {
    const glm::dvec3 normal(known.at(sample.u, sample.v).normal);
    const glm::dvec3 turn = glm::cross(point(sample) - middle, normal) / radius_mm;
    sample.moves = {turn.x, turn.y, turn.z, normal.x, normal.y, normal.z};
  }
}

/// What lies further off than this plays no part in the fit [mm].
double trimAt(const std::vector<Sample>& samples, const Motion& motion, double agree_mm) {
  std::vector<double> off;
  for (const Sample& sample : samples) {
    if (sample.off(motion) <= agree_mm) off.push_back(sample.off(motion));
  }
  if (off.empty()) return agree_mm;
  const auto middle = off.begin() + static_cast<std::ptrdiff_t>(off.size() / 2);
  std::nth_element(off.begin(), middle, off.end());
  return std::min(agree_mm, std::max(kLeastTrimMm, kTrim * kDeviationOfMedian * *middle));
}

/// The small motion of a part that explains most of the errors.
Motion fitMotion(const std::vector<Sample>& samples, double agree_mm) {
  Motion motion{};
  for (int round = 0; round < kRounds; ++round) {
    const double trim = trimAt(samples, motion, agree_mm);
    NormalEquations<6> equations;
    for (const Sample& sample : samples) {
      if (sample.off(motion) > trim) continue;
      // Minus what is left of it along the normal when the part has moved on by a step.
      equations.add(sample.moves, -sample.rest(motion) * sample.facing);
    }
    const Motion step = equations.solve(kDamping);
    for (std::size_t i = 0; i < motion.size(); ++i) motion[i] += step[i];
  }
  return motion;
}

/// Adds the pairs and second differences that begin at a pixel and go on by `step`.
void tallyFrom(const Image<float>& errors_mm,
               const KnownSurface& known,
               const glm::ivec2& at,
               const glm::ivec2& step,
               SurfaceErrorTally& tally) {
  const double here = errors_mm.at(at.x, at.y);
  const int part = known.at(at.x, at.y).part;
  const auto errorAt = [&](int shift) {
    const glm::ivec2 there = at + shift * step;
    const bool same =
        errors_mm.contains(there.x, there.y) && known.at(there.x, there.y).part == part;
    return same ? static_cast<double>(errors_mm.at(there.x, there.y))
                : std::numeric_limits<double>::quiet_NaN();
  };
  const double second = here - 2.0 * errorAt(1) + errorAt(2);
  if (!std::isnan(second)) tally.second_mm.push_back(static_cast<float>(std::abs(second)));
  for (std::size_t i = 0; i < kErrorShiftsPx.size(); ++i) {
    const double there = errorAt(kErrorShiftsPx[i]);
    if (std::isnan(there)) continue;
    ErrorPairs& pairs = tally.pairs[i];
    pairs.half_squares += 0.5 * (here - there) * (here - there);
    pairs.mean_squares += 0.5 * (here * here + there * there);
    ++pairs.count;
  }
}

}  // namespace

Image<float> surfaceErrors(const DepthImage& image,
                           const KnownSurface& known,
                           const std::vector<KnownPart>& parts) {
  Image<float> errors(known.width(), known.height(), std::numeric_limits<float>::quiet_NaN());
  std::vector<std::vector<Sample>> all = samplesOf(image, known, parts);
  for (std::size_t part = 0; part < parts.size(); ++part) {
    std::vector<Sample>& samples = all[part];
    if (samples.size() < kLeastPixels) continue;
    const double agree = agreementMm(parts[part]);
    fillMoves(samples, known, image.camera, 0.5 * parts[part].diameter_mm);
    const Motion motion = fitMotion(samples, agree);
    std::erase_if(samples, [&](const Sample& sample) { return sample.off(motion) > agree; });
    if (samples.size() < kLeastPixels) continue;
    for (const Sample& sample : samples) {
      errors.at(sample.u, sample.v) = static_cast<float>(sample.rest(motion));
    }
  }
  return errors;
}

void SurfaceErrorTally::add(const SurfaceErrorTally& other) {
  second_mm.insert(second_mm.end(), other.second_mm.begin(), other.second_mm.end());
  squares += other.squares;
  sizes += other.sizes;
  pixels += other.pixels;
  deep_squares += other.deep_squares;
  deep_pixels += other.deep_pixels;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    pairs[i].half_squares += other.pairs[i].half_squares;
    pairs[i].mean_squares += other.pairs[i].mean_squares;
    pairs[i].count += other.pairs[i].count;
  }
}

SurfaceErrorTally tallySurfaceErrors(const Image<float>& errors_mm, const KnownSurface& known) {
  SurfaceErrorTally tally;
  for (int v = 0; v < errors_mm.height(); ++v) {
    for (int u = 0; u < errors_mm.width(); ++u) {
      const double error = errors_mm.at(u, v);
      if (std::isnan(error)) continue;
      tally.squares += error * error;
      tally.sizes += std::abs(error);
      ++tally.pixels;
      if (known.at(u, v).inside_px >= kDeepPx) {
        tally.deep_squares += error * error;
        ++tally.deep_pixels;
      }
      tallyFrom(errors_mm, known, {u, v}, {1, 0}, tally);
      tallyFrom(errors_mm, known, {u, v}, {0, 1}, tally);
    }
  }
  return tally;
}

double noiseBetweenNeighbours(std::vector<float> second_mm) {
  if (second_mm.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::sort(second_mm.begin(), second_mm.end());
  std::vector<double> squares{0.0};  // of so many of the smallest
  for (const double second : second_mm) squares.push_back(squares.back() + second * second);
  const auto rmsOf = [&squares](std::size_t count) {
    return std::sqrt(squares[count] / static_cast<double>(std::max<std::size_t>(count, 1)));
  };
  const auto count = static_cast<double>(second_mm.size());
  double deviation = rmsOf(static_cast<std::size_t>(kFirstShare * count)) / kFirstRms;
  for (int round = 0; round < kCutRounds; ++round) {
    const auto end =
        std::upper_bound(second_mm.begin(), second_mm.end(), static_cast<float>(kCut * deviation));
    deviation = rmsOf(static_cast<std::size_t>(end - second_mm.begin())) / kCutRms;
  }
  return deviation / std::sqrt(6.0);
}

}  // namespace rangepose
