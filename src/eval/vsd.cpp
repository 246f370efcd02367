#include "eval/vsd.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "stages/surface.h"

namespace rangepose {
namespace {

/// Factor from depth to distance at a pixel.
double distanceFactor(const Camera& camera, int u, int v) {
  return camera.orthographic ? 1.0 : glm::length(camera.unproject(u, v, 1.0));
}

PixelBox unionOf(const PixelBox& a, const PixelBox& b) {
  if (a.empty()) return b;
  if (b.empty()) return a;
  return {std::min(a.x0, b.x0), std::min(a.y0, b.y0), std::max(a.x1, b.x1), std::max(a.y1, b.y1)};
}

float at(const PosedModel& model, int u, int v) {
  const int x = u - model.box.x0;
  const int y = v - model.box.y0;
  return model.distance_mm.contains(x, y) ? model.distance_mm.at(x, y) : 0.0f;
}

/// Calls use(measured, estimate, truth) [mm] for the pixels around both models.
template <typename Use>
void forEachPixel(const Image<float>& measured_mm,
                  const PosedModel& estimate,
                  const PosedModel& truth,
                  const Use& use) {
  const PixelBox box = unionOf(estimate.box, truth.box);
  for (int v = box.y0; v < box.y1; ++v) {
    for (int u = box.x0; u < box.x1; ++u)
      use(measured_mm.at(u, v), at(estimate, u, v), at(truth, u, v));
  }
}

bool isVisible(float model_mm, float measured_mm, float delta_mm) {
  return model_mm > 0.0f && (measured_mm == 0.0f || model_mm - measured_mm <= delta_mm);
}

}  // namespace

void VsdOptions::check() const {
  RP_CHECK(delta_mm >= 0.0, "VSD: delta_mm must not be negative");
  RP_CHECK(!taus.empty(), "VSD: taus must not be empty");
  for (const double tau : taus) RP_CHECK(tau > 0.0, "VSD: taus must be positive");
}

Image<float> distancesOf(const DepthImage& image) {
  Image<float> distance = image.depth_mm;
  for (int v = 0; v < distance.height(); ++v) {
    for (int u = 0; u < distance.width(); ++u) {
      float& value = distance.at(u, v);
      value = static_cast<float>(value * distanceFactor(image.camera, u, v));
    }
  }
  return distance;
}

PosedModel renderPosed(const Mesh& mesh, const Camera& camera, const Pose& camera_from_object) {
  const Sphere sphere = boundingSphere(mesh);
  const int all = std::max(camera.width, camera.height);
  const SurfaceWindow window =
      windowAround(camera, camera_from_object * sphere.center_mm, sphere.radius_mm, all);
  PosedModel model;
  if (window.width == 0) return model;
  const Image<SurfaceTexel> surface = host::renderSurface(mesh, camera, camera_from_object, window);
  model.box = {window.x0, window.y0, window.x0 + window.width, window.y0 + window.height};
  model.distance_mm = Image<float>(window.width, window.height);
  for (int y = 0; y < window.height; ++y) {
    for (int x = 0; x < window.width; ++x) {
      model.distance_mm.at(x, y) = static_cast<float>(
          surface.at(x, y).w * distanceFactor(camera, window.x0 + x, window.y0 + y));
    }
  }
  return model;
}

std::vector<double> vsdErrors(const Image<float>& measured_mm,
                              const PosedModel& estimate,
                              const PosedModel& truth,
                              double diameter_mm,
                              const VsdOptions& options) {
  const float delta = static_cast<float>(options.delta_mm);
  std::vector<int> wrong(options.taus.size(), 0);
  int either = 0;
  int both = 0;
  forEachPixel(measured_mm, estimate, truth, [&](float measured, float found, float real) {
    const bool truth_visible = isVisible(real, measured, delta);
    const bool estimate_visible =
        isVisible(found, measured, delta) || (truth_visible && found > 0.0f);
    if (!truth_visible && !estimate_visible) return;
    ++either;
    if (!truth_visible || !estimate_visible) return;
    ++both;
    const double share = std::abs(static_cast<double>(found) - real) / diameter_mm;
    for (std::size_t i = 0; i < wrong.size(); ++i) wrong[i] += share >= options.taus[i] ? 1 : 0;
  });
  std::vector<double> errors(wrong.size(), 1.0);
  if (either == 0) return errors;
  for (std::size_t i = 0; i < wrong.size(); ++i) {
    errors[i] = static_cast<double>(wrong[i] + either - both) / either;
  }
  return errors;
}

double unlikeness(const Image<float>& measured_mm,
                  const PosedModel& estimate,
                  const PosedModel& truth,
                  double apart_mm) {
  const auto apart = static_cast<float>(apart_mm);
  int either = 0;
  int alike = 0;
  forEachPixel(measured_mm, estimate, truth, [&](float measured, float found, float real) {
    if (measured == 0.0f) return;
    if (!isVisible(found, measured, apart) && !isVisible(real, measured, apart)) return;
    ++either;
    if (found > 0.0f && real > 0.0f && std::abs(found - real) < apart) ++alike;
  });
  return either == 0 ? 1.0 : static_cast<double>(either - alike) / either;
}

}  // namespace rangepose
