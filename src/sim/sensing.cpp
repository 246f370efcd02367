#include "sim/sensing.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "core/error.h"
#include "sim/infrared.h"
#include "sim/matching.h"
#include "sim/time_of_flight.h"

namespace rangepose {
namespace {

/// Random numbers of one image that have nothing to do with each other.
enum Use : std::uint64_t { kSurfaces = 1, kFirstImage = 2, kSecondImage = 3, kPhase = 4 };

std::uint64_t seedFor(std::uint64_t seed, Use use) {
  return seed * 0x9E3779B97F4A7C15u + static_cast<std::uint64_t>(use) * 0xBF58476D1CE4E5B9u;
}

ProjectorView projectorAt(const glm::dvec3& position_mm,
                          const Camera& camera,
                          const RenderFrom& render) {
  const int margin_px = camera.width / 2;  // it lights more than the camera sees
  const CleanView lit = render(padded(camera, margin_px), position_mm);
  return {lit.camera, depthOf(lit.surface), position_mm};
}

Image<float> senseByLight(const CleanView& seen,
                          const RenderFrom& render,
                          const SensorModel& sensor,
                          std::uint64_t seed) {
  std::optional<ProjectorView> projector;
  if (!seen.camera.orthographic) {
    const bool along_y = sensor.kind == SensorKind::kLaser;
    const glm::dvec3 position_mm = along_y ? glm::dvec3(0.0, sensor.baseline_mm, 0.0)
                                           : glm::dvec3(sensor.baseline_mm, 0.0, 0.0);
    projector = projectorAt(position_mm, seen.camera, render);
  }
  Random random(seed);
  Image<float> depth_mm = sensed(seen.surface, seen.camera, projector, sensor.noise, random);
  for (std::size_t i = 0; i < depth_mm.size(); ++i) {
    if (seen.shiny.data()[i] != 0) depth_mm.data()[i] = 0.0f;
  }
  return depth_mm;
}

/// Disparity follows the focal length.
MatchingSensor scaled(const SensorModel& sensor, const Camera& camera) {
  MatchingSensor matching = sensor.matching;
  const double scale = camera.fx / sensor.fx;
  matching.least_disparity_px = static_cast<int>(std::floor(scale * matching.least_disparity_px));
  constexpr int kUnit = 16;  // OpenCV counts disparities in these
  const double needed = scale * sensor.matching.disparities / kUnit;
  matching.disparities = kUnit * std::max(1, static_cast<int>(std::ceil(needed)));
  return matching;
}

Image<float> depthFrom(const Image<float>& disparity_px, const Camera& camera, double baseline_mm) {
  Image<float> depth_mm(disparity_px.width(), disparity_px.height(), 0.0f);
  for (std::size_t i = 0; i < depth_mm.size(); ++i) {
    const double disparity = disparity_px.data()[i];
    if (disparity <= 0.0) continue;
    const double steps = std::round(camera.fx * baseline_mm / disparity / camera.depth_scale);
    depth_mm.data()[i] = static_cast<float>(steps * camera.depth_scale);
  }
  return depth_mm;
}

/// Smoothed over pixels that have a disparity; the others stay without one.
Image<float> smoothed(const Image<float>& disparity_px, double deviation_px) {
  if (deviation_px <= 0.0) return disparity_px;
  Image<float> known(disparity_px.width(), disparity_px.height());
  std::transform(disparity_px.begin(), disparity_px.end(), known.begin(), [](float disparity) {
    return disparity > 0.0f ? 1.0f : 0.0f;
  });
  Image<float> result = blurred(disparity_px, deviation_px);
  const Image<float> weight = blurred(known, deviation_px);
  for (std::size_t i = 0; i < result.size(); ++i) {
    result.data()[i] = known.data()[i] > 0.0f ? result.data()[i] / weight.data()[i] : 0.0f;
  }
  return result;
}

Image<float> senseByMatching(const CleanView& seen,
                             const RenderFrom& render,
                             const SensorModel& sensor,
                             std::uint64_t seed) {
  const Camera& camera = seen.camera;
  const MatchingSensor matching = scaled(sensor, camera);
  const bool stereo = sensor.kind == SensorKind::kStereo;
  const glm::dvec3 projector_mm(stereo ? matching.projector_mm : sensor.baseline_mm, 0.0, 0.0);
  const ProjectorView projector = projectorAt(projector_mm, camera, render);
  const DotPattern dots(camera, matching);
  const Illumination light{&projector, &dots, matching.ambient};
  const std::vector<Reflectance> surfaces =
      drawReflectances(seen.silhouette_px.size(), seedFor(seed, kSurfaces));
  const auto imageFrom = [&](const Viewpoint& from, Use use) {
    return exposed(infraredImage(from, light, surfaces, matching), matching, seedFor(seed, use));
  };
  const Image<std::uint8_t> first = imageFrom({seen, glm::dvec3(0.0)}, kFirstImage);
  Image<std::uint8_t> second;
  if (stereo) {
    const glm::dvec3 position_mm(sensor.baseline_mm, 0.0, 0.0);
    second = imageFrom({render(camera, position_mm), position_mm}, kSecondImage);
  } else {
    second = storedPattern(dots, camera, matching);
  }
  const Image<float> disparity_px = matchedDisparity(first, second, matching, sensor.kind);
  return depthFrom(smoothed(disparity_px, matching.smoothing_px), camera, sensor.baseline_mm);
}

}  // namespace

Image<float> sense(const CleanView& seen,
                   const RenderFrom& render,
                   const SensorModel& sensor,
                   std::uint64_t seed) {
  if (seen.camera.orthographic && needsPinhole(sensor)) {
    throw Error("sensor " + sensor.name +
                ": has no parallel rays; take a perspective camera or another sensor");
  }
  const bool by_light =
      sensor.kind == SensorKind::kStructuredLight || sensor.kind == SensorKind::kLaser;
  if (sensor.kind == SensorKind::kNone) return depthOf(seen.surface);
  if (by_light) return senseByLight(seen, render, sensor, seed);
  if (sensor.kind == SensorKind::kTimeOfFlight) {
    const std::vector<Reflectance> surfaces =
        drawReflectances(seen.silhouette_px.size(), seedFor(seed, kSurfaces));
    return timeOfFlightDepth(seen, surfaces, sensor.tof, seedFor(seed, kPhase));
  }
  return senseByMatching(seen, render, sensor, seed);
}

}  // namespace rangepose
