#include "sim/time_of_flight.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>

#include "core/parallel.h"
#include "sim/random.h"

namespace rangepose {
namespace {

constexpr double kLightMmPerS = 2.99792458e11;

using Wave = std::complex<double>;

/// A pixel's surface as the light sees it.
struct Patch {
  glm::dvec3 at_mm{0.0};
  glm::dvec3 normal{0.0};
  double way_mm = 0.0;   ///< from the camera; 0 nothing
  double diffuse = 0.0;  ///< 0..1
  double lit = 0.0;      ///< light that falls onto it, of a facing surface at 1 m
  double area_mm2 = 0.0;
};

Patch patchAt(const CleanView& view, const std::vector<Reflectance>& reflectances, int u, int v) {
  constexpr double kUnitWayMm = 1000.0;
  Patch patch;
  const SurfaceTexel& texel = view.surface.at(u, v);
  if (texel.w == 0.0f || view.shiny.at(u, v) != 0) return patch;
  const int part = view.part.at(u, v);
  patch.at_mm = view.camera.unproject(u, v, texel.w);
  patch.normal = glm::dvec3(texel);
  patch.way_mm = glm::length(patch.at_mm);
  patch.diffuse =
      (part < 0 ? reflectances.back() : reflectances[static_cast<std::size_t>(part)]).diffuse;
  const double facing = std::max(0.05, -glm::dot(patch.normal, patch.at_mm) / patch.way_mm);
  patch.lit = facing * (kUnitWayMm / patch.way_mm) * (kUnitWayMm / patch.way_mm);
  const double across_mm = texel.w / view.camera.fx;
  patch.area_mm2 = across_mm * across_mm / facing;
  return patch;
}

/// Light that comes back after a way there and back.
Wave wave(double strength, double way_mm, double rad_per_mm) {
  return std::polar(strength, rad_per_mm * way_mm);
}

/// Other surfaces are looked for that far away [px].
constexpr double kFirstPx = 3.0;
constexpr double kLastPx = 60.0;

/// Directions and distances in which other surfaces are looked for [px]: a spiral.
std::vector<std::array<int, 2>> samplesAround() {
  constexpr int kSamples = 32;
  const double turn = std::numbers::pi * (3.0 - std::sqrt(5.0));
  std::vector<std::array<int, 2>> samples;
  for (int i = 0; i < kSamples; ++i) {
    const double radius = kFirstPx * std::pow(kLastPx / kFirstPx, (i + 0.5) / kSamples);
    samples.push_back({static_cast<int>(std::lround(radius * std::cos(turn * i))),
                       static_cast<int>(std::lround(radius * std::sin(turn * i)))});
  }
  return samples;
}

/// Pixels that a sample of the spiral stands for: rings grow with the square of their radius.
double pixelsOf(const std::array<int, 2>& sample, std::size_t samples) {
  const double log_range = std::log(kLastPx / kFirstPx);
  const double radius_sq = sample[0] * sample[0] + sample[1] * sample[1];
  return 2.0 * std::numbers::pi * radius_sq * log_range / static_cast<double>(samples);
}

/// Light that reaches `to` by way of `from` and goes on to the camera (one bounce between two
/// diffuse surfaces).
Wave bounced(const Patch& from, const Patch& to, double pixels, double rad_per_mm) {
  const glm::dvec3 between = to.at_mm - from.at_mm;
  const double distance_sq = glm::dot(between, between);
  if (distance_sq < 1.0) return {};
  const double distance = std::sqrt(distance_sq);
  const double out = glm::dot(from.normal, between) / distance;
  const double in = -glm::dot(to.normal, between) / distance;
  if (out <= 0.0 || in <= 0.0) return {};
  const double area_mm2 = pixels * from.area_mm2;
  // A patch that is wide for its distance fills at most half of what the other one sees.
  const double share = std::min(0.5, out * in * area_mm2 / (std::numbers::pi * distance_sq));
  return wave(
      from.lit * from.diffuse * share * to.diffuse, from.way_mm + distance + to.way_mm, rad_per_mm);
}

struct Waves {
  Image<float> real;
  Image<float> imaginary;
};

/// Of each pixel by itself, before the lens mixes them.
Waves wavesOf(const Image<Patch>& patches, double rad_per_mm) {
  const std::vector<std::array<int, 2>> around = samplesAround();
  Waves waves{Image<float>(patches.width(), patches.height()),
              Image<float>(patches.width(), patches.height())};
  parallelFor(patches.height(), 8, [&](int first, int last) {
    for (int v = first; v < last; ++v) {
      for (int u = 0; u < patches.width(); ++u) {
        const Patch& patch = patches.at(u, v);
        if (patch.way_mm == 0.0) continue;
        Wave sum = wave(patch.lit * patch.diffuse, 2.0 * patch.way_mm, rad_per_mm);
        for (const std::array<int, 2>& offset : around) {
          const int x = u + offset[0];
          const int y = v + offset[1];
          if (!patches.contains(x, y) || patches.at(x, y).way_mm == 0.0) continue;
          sum += bounced(patches.at(x, y), patch, pixelsOf(offset, around.size()), rad_per_mm);
        }
        waves.real.at(u, v) = static_cast<float>(sum.real());
        waves.imaginary.at(u, v) = static_cast<float>(sum.imag());
      }
    }
  });
  return waves;
}

/// Way of light to a surface that the wave speaks of [mm], nearest to the expected one.
double wayOf(const Wave& sum, double expected_mm, double rad_per_mm) {
  const double period_mm = std::numbers::pi / rad_per_mm;  // of the way to the surface
  const double way_mm = 0.5 * std::arg(sum) / rad_per_mm;
  return way_mm + period_mm * std::round((expected_mm - way_mm) / period_mm);
}

}  // namespace

Image<float> timeOfFlightDepth(const CleanView& view,
                               const std::vector<Reflectance>& reflectances,
                               const TimeOfFlightSensor& sensor,
                               std::uint64_t seed) {
  const Camera& camera = view.camera;
  const double rad_per_mm = 2.0 * std::numbers::pi * sensor.modulation_mhz * 1e6 / kLightMmPerS;
  Image<Patch> patches(camera.width, camera.height);
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) patches.at(u, v) = patchAt(view, reflectances, u, v);
  }
  Waves waves = wavesOf(patches, rad_per_mm);
  waves.real = blurred(waves.real, sensor.blur_px);
  waves.imaginary = blurred(waves.imaginary, sensor.blur_px);
  Random random(seed);
  Image<float> depth_mm(camera.width, camera.height, 0.0f);
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      const double error = random.normal();  // drawn for each pixel alike
      const Patch& patch = patches.at(u, v);
      const Wave sum(waves.real.at(u, v), waves.imaginary.at(u, v));
      const double signal = std::abs(sum);
      if (patch.way_mm == 0.0 || signal < sensor.least_signal) continue;
      constexpr double kDark = 0.1;
      double way_mm = wayOf(sum, patch.way_mm, rad_per_mm);
      way_mm += sensor.bias_mm * std::min(2.0, kDark / signal);
      way_mm += sensor.wiggle_mm * std::sin(8.0 * rad_per_mm * way_mm);
      way_mm += sensor.sigma_mm * error / std::sqrt(signal);
      const double z_mm = way_mm * patch.at_mm.z / patch.way_mm;
      const double steps = std::round(z_mm / camera.depth_scale);
      if (steps >= 1.0) depth_mm.at(u, v) = static_cast<float>(steps * camera.depth_scale);
    }
  }
  return depth_mm;
}

}  // namespace rangepose
