#include "sim/sensor_noise.h"

#include <algorithm>
#include <cmath>

namespace rangepose {
namespace {

/// The depth across the largest jump beside a pixel; nothing where there is no jump. 0: the other
/// side is not seen at all.
std::optional<double> acrossJump(const Image<SurfaceTexel>& surface, int u, int v, double jump_mm) {
  const float depth = surface.at(u, v).w;
  std::optional<double> across;
  double largest = jump_mm;
  for (int n = 0; n < 9; ++n) {
    const int x = u + n % 3 - 1;
    const int y = v + n / 3 - 1;
    if (!surface.contains(x, y)) continue;
    const double jump = std::abs(surface.at(x, y).w - depth);
    if (jump <= largest) continue;
    largest = jump;
    across = surface.at(x, y).w;
  }
  return across;
}

}  // namespace

SensorNoise sensorNoise(int level) {
  SensorNoise noise;
  noise.sigma_mm = level >= 2 ? 1.0 : 0.3;
  noise.edge_loss = level >= 2 ? 0.6 : 0.3;
  noise.edge_mix = level >= 2 ? 0.2 : 0.1;
  noise.grazing_cosine = level >= 2 ? 0.45 : 0.3;
  noise.random_loss = level >= 2 ? 0.10 : 0.002;
  return noise;
}

Image<float> depthOf(const Image<SurfaceTexel>& surface) {
  Image<float> depth_mm(surface.width(), surface.height());
  std::transform(surface.begin(), surface.end(), depth_mm.begin(), [](const SurfaceTexel& texel) {
    return texel.w;
  });
  return depth_mm;
}

bool isLit(const ProjectorView& projector, const glm::dvec3& point_mm) {
  constexpr double kToleranceMm = 1.5;  // a lit point must not shadow itself
  const glm::dvec2 pixel = projector.camera.project(point_mm);
  // Between two pixels along the baseline, on the nearest one across it: rows (or columns) of the
  // two views are the same.
  const bool along_y = projector.position_mm.y != 0.0;
  const int u =
      static_cast<int>(along_y ? std::lround(pixel.x) : static_cast<long>(std::floor(pixel.x)));
  const int v =
      static_cast<int>(along_y ? static_cast<long>(std::floor(pixel.y)) : std::lround(pixel.y));
  for (int k = 0; k <= 1; ++k) {
    const int x = along_y ? u : u + k;
    const int y = along_y ? v + k : v;
    if (!projector.depth_mm.contains(x, y)) continue;
    const float first_hit = projector.depth_mm.at(x, y);
    if (first_hit == 0.0f || point_mm.z <= first_hit + kToleranceMm) return true;
  }
  return false;
}

Image<float> sensed(const Image<SurfaceTexel>& surface,
                    const Camera& camera,
                    const std::optional<ProjectorView>& projector,
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
      double z = texel.w;
      const glm::dvec3 ray = camera.viewingRay(camera.unproject(u, v, z));
      const double cosine = std::abs(glm::dot(glm::dvec3(texel), ray));
      if (loss_draw < noise.random_loss || grazing_draw * noise.grazing_cosine > cosine) continue;
      if (projector && !isLit(*projector, camera.unproject(u, v, z) - projector->position_mm)) {
        continue;
      }
      if (edge_draw < noise.edge_loss + noise.edge_mix) {
        const std::optional<double> across = acrossJump(surface, u, v, noise.jump_mm);
        if (across && edge_draw < noise.edge_loss) continue;
        if (across && *across > 0.0)
          z += (edge_draw - noise.edge_loss) / noise.edge_mix * (*across - z);
      }
      const double sigma_mm = noise.sigma_mm * (z / 1000.0) * (z / 1000.0) / std::max(cosine, 0.2);
      const double steps = std::round((z + sigma_mm * error) / camera.depth_scale);
      if (steps >= 1.0) depth_mm.at(u, v) = static_cast<float>(steps * camera.depth_scale);
    }
  }
  return depth_mm;
}

}  // namespace rangepose
