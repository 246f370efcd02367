#include "sim/sensor_noise.h"

#include <algorithm>
#include <cmath>

namespace rangepose {
namespace {

bool besideJump(const Image<SurfaceTexel>& surface, int u, int v, double jump_mm) {
  const float depth = surface.at(u, v).w;
  for (int n = 0; n < 9; ++n) {
    const int x = u + n % 3 - 1;
    const int y = v + n / 3 - 1;
    if (surface.contains(x, y) && std::abs(surface.at(x, y).w - depth) > jump_mm) return true;
  }
  return false;
}

}  // namespace

SensorNoise sensorNoise(int level) {
  SensorNoise noise;
  noise.sigma_mm = level >= 2 ? 1.2 : 0.3;
  noise.edge_loss = level >= 2 ? 0.6 : 0.3;
  noise.grazing_cosine = level >= 2 ? 0.45 : 0.3;
  noise.random_loss = level >= 2 ? 0.03 : 0.002;
  return noise;
}

Image<float> depthOf(const Image<SurfaceTexel>& surface) {
  Image<float> depth_mm(surface.width(), surface.height());
  std::transform(surface.begin(), surface.end(), depth_mm.begin(), [](const SurfaceTexel& texel) {
    return texel.w;
  });
  return depth_mm;
}

bool isLit(const ProjectorView& projector, const Camera& camera, int u, int v, double depth_mm) {
  constexpr double kToleranceMm = 1.5;  // a lit point must not shadow itself
  glm::dvec3 point = camera.unproject(u, v, depth_mm);
  point.x -= projector.baseline_mm;
  const glm::dvec2 pixel = projector.camera.project(point);
  const int left = static_cast<int>(std::floor(pixel.x));
  const int row = static_cast<int>(std::lround(pixel.y));
  for (int x = left; x <= left + 1; ++x) {
    if (!projector.depth_mm.contains(x, row)) continue;
    const float first_hit = projector.depth_mm.at(x, row);
    if (first_hit == 0.0f || depth_mm <= first_hit + kToleranceMm) return true;
  }
  return false;
}

Image<float> sensed(const Image<SurfaceTexel>& surface,
                    const Camera& camera,
                    const ProjectorView& projector,
                    const SensorNoise& noise,
                    Random& random) {
  Image<float> depth_mm(surface.width(), surface.height(), 0.0f);
  for (int v = 0; v < surface.height(); ++v) {
    for (int u = 0; u < surface.width(); ++u) {
      const SurfaceTexel& texel = surface.at(u, v);
      if (texel.w == 0.0f) continue;
      // Drawn for each pixel alike, so that one lost pixel does not change the noise of the others.
      const double edge_draw = random.uniform();
      const double grazing_draw = random.uniform();
      const double loss_draw = random.uniform();
      const double error = random.normal();
      const double z = texel.w;
      const glm::dvec3 ray = camera.viewingRay(camera.unproject(u, v, z));
      const double cosine = std::abs(glm::dot(glm::dvec3(texel), ray));
      const bool lost = loss_draw < noise.random_loss ||
                        grazing_draw * noise.grazing_cosine > cosine ||
                        (edge_draw < noise.edge_loss && besideJump(surface, u, v, noise.jump_mm)) ||
                        !isLit(projector, camera, u, v, z);
      if (lost) continue;
      const double sigma_mm = noise.sigma_mm * (z / 1000.0) * (z / 1000.0) / std::max(cosine, 0.2);
      const double steps = std::round((z + sigma_mm * error) / camera.depth_scale);
      if (steps >= 1.0) depth_mm.at(u, v) = static_cast<float>(steps * camera.depth_scale);
    }
  }
  return depth_mm;
}

}  // namespace rangepose
