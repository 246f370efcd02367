#include "stages/check_host.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace rangepose::host {
namespace {

/// Reads the measured surface at camera pixels.
class Measured {
 public:
  Measured(const DepthImage& depth, double tolerance_mm)
      : depth_(depth), tolerance_mm_(tolerance_mm) {}

  bool inImage(int u, int v) const { return depth_.depth_mm.contains(u, v); }
  double at(int u, int v) const {
    return inImage(u, v) ? static_cast<double>(depth_.depth_mm.at(u, v)) : 0.0;
  }

  /// Normal towards the camera from the points `reach` pixels away; nothing where the surface ends.
  std::optional<glm::dvec3> normal(int u, int v, int reach) const {
    const std::optional<glm::dvec3> across = slope(u, v, reach, 0);
    const std::optional<glm::dvec3> down = slope(u, v, 0, reach);
    if (!across || !down) return std::nullopt;
    return glm::normalize(glm::cross(*down, *across));
  }

 private:
  std::optional<glm::dvec3> slope(int u, int v, int du, int dv) const {
    const double before = at(u - du, v - dv);
    const double here = at(u, v);
    const double after = at(u + du, v + dv);
    if (before == 0.0 || after == 0.0) return std::nullopt;
    // Where the surface bends by more than the tolerance it is not one surface.
    if (std::abs(before + after - 2.0 * here) > 4.0 * tolerance_mm_) return std::nullopt;
    return depth_.camera.unproject(u + du, v + dv, after) -
           depth_.camera.unproject(u - du, v - dv, before);
  }

  const DepthImage& depth_;
  double tolerance_mm_;
};

struct Tally {
  double explained = 0.0;
  double contradicted = 0.0;
  double hidden = 0.0;
  double buried = 0.0;
  double missing = 0.0;
  double weak = 0.0;
  double residual_mm = 0.0;
  double agreeing = 0.0;
  int pixels = 0;
  double border = 0.0;
  double border_ends = 0.0;
};

void judgePixel(const SurfaceTexel& model,
                const Measured& measured,
                int u,
                int v,
                int normal_reach,
                const CheckOptions& options,
                Tally& tally) {
  ++tally.pixels;
  const double seen = measured.at(u, v);
  if (seen == 0.0) {
    tally.missing += 1.0;
    return;
  }
  const double gap = seen - static_cast<double>(model.w);
  // Along the model's normal a depth difference on a slope is smaller than along the ray.
  const double distance = std::abs(gap) * std::max(0.3, static_cast<double>(std::abs(model.z)));
  if (distance > options.tolerance_mm) {
    const bool just = distance <= options.buried_tolerances * options.tolerance_mm;
    (gap > 0.0 ? tally.contradicted : just ? tally.buried : tally.hidden) += 1.0;
    return;
  }
  const double ratio = distance / options.tolerance_mm;
  double agreement = 1.0 - 0.5 * ratio * ratio;
  if (const std::optional<glm::dvec3> normal = measured.normal(u, v, normal_reach)) {
    if (glm::dot(*normal, glm::dvec3(model)) < std::cos(options.max_tilt_rad)) agreement *= 0.3;
  }
  tally.explained += agreement;
  tally.weak += 1.0 - agreement;
  tally.residual_mm += distance;
  tally.agreeing += 1.0;
}

/// Whether the data goes on smoothly beyond the model's outline, in the direction (dx, dy).
void judgeBorder(const Image<SurfaceTexel>& surface,
                 const SurfaceWindow& window,
                 const Measured& measured,
                 int x,
                 int y,
                 const CheckOptions& options,
                 Tally& tally) {
  constexpr std::array<std::array<int, 2>, 4> kDirections = {{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}};
  constexpr int kOut = 2;
  const double model = static_cast<double>(surface.at(x, y).w);
  const double inside = measured.at(window.x0 + x * window.step, window.y0 + y * window.step);
  // Behind nearer data and outside of the image nothing can be said: that counts half.
  const bool covered = inside != 0.0 && inside < model - options.tolerance_mm;
  for (const auto& [dx, dy] : kDirections) {
    const int near_x = x + dx;
    const int near_y = y + dy;
    if (surface.contains(near_x, near_y) && surface.at(near_x, near_y).w > 0.0f) continue;
    const int out_u = window.x0 + (x + kOut * dx) * window.step;
    const int out_v = window.y0 + (y + kOut * dy) * window.step;
    const double outside = measured.at(out_u, out_v);
    tally.border += 1.0;
    if (covered || !measured.inImage(out_u, out_v)) {
      tally.border_ends += 0.5;
      continue;
    }
    // Nearer data may cover the outline; farther or missing data ends the surface.
    if (outside == 0.0 || outside > model + 1.5 * options.tolerance_mm) {
      tally.border_ends += 1.0;
    } else if (outside < model - 1.5 * options.tolerance_mm) {
      tally.border_ends += 0.5;
    }
  }
}

/// Shares and score; `outline_factor` is what the outline leaves of the score.
CheckResult summarize(const Tally& tally,
                      const CheckOptions& options,
                      double outline_factor,
                      double visible_mm2) {
  CheckResult result;
  result.pixels = tally.pixels;
  if (tally.pixels == 0) return result;
  const double all = tally.pixels;
  result.explained = tally.explained / all;
  result.contradicted = tally.contradicted / all;
  result.hidden = tally.hidden / all;
  result.buried = tally.buried / all;
  result.missing = tally.missing / all;
  result.weak = tally.weak / all;
  result.explained_mm2 = result.explained * visible_mm2;
  result.residual_mm = tally.agreeing > 0.0 ? tally.residual_mm / tally.agreeing : 0.0;
  const double against = options.contradicted * result.contradicted +
                         options.missing * result.missing + options.hidden * result.hidden +
                         options.buried * result.buried + options.weak * result.weak;
  result.score = result.explained / std::max(result.explained + against, 1e-9) * outline_factor;
  return result;
}

}  // namespace

CheckResult check(const Image<SurfaceTexel>& surface,
                  const SurfaceWindow& window,
                  const DepthImage& depth,
                  const CheckOptions& options) {
  const Measured measured(depth, options.tolerance_mm);
  const int normal_reach = std::max(2, window.step);
  Tally tally;
  double visible_mm2 = 0.0;
  for (int y = 0; y < surface.height(); ++y) {
    for (int x = 0; x < surface.width(); ++x) {
      const SurfaceTexel& texel = surface.at(x, y);
      if (texel.w <= 0.0f) continue;
      const double width_mm =
          window.step * depth.camera.pixelSpacingMm(static_cast<double>(texel.w));
      visible_mm2 += width_mm * width_mm;
      judgePixel(texel,
                 measured,
                 window.x0 + x * window.step,
                 window.y0 + y * window.step,
                 normal_reach,
                 options,
                 tally);
      judgeBorder(surface, window, measured, x, y, options, tally);
    }
  }
  const double outline = tally.border > 0.0 ? tally.border_ends / tally.border : 0.0;
  CheckResult result =
      summarize(tally, options, 1.0 - options.border + options.border * outline, visible_mm2);
  result.outline = outline;
  return result;
}

CheckResult checkPoints(const std::vector<SurfacePoint>& points,
                        const Pose& camera_from_object,
                        double visible_mm2,
                        const DepthImage& depth,
                        const CheckOptions& options) {
  constexpr int kNormalReach = 2;
  const Measured measured(depth, options.tolerance_mm);
  Tally tally;
  for (const SurfacePoint& surface : points) {
    const glm::dvec3 point = camera_from_object * glm::dvec3(surface.position_mm);
    if (!depth.camera.orthographic && point.z <= 1.0) continue;
    const glm::dvec2 pixel = glm::floor(depth.camera.project(point) + 0.5);
    // Not "outside", so that a NaN counts as outside too.
    if (!(pixel.x >= 0.0 && pixel.y >= 0.0 && pixel.x < depth.camera.width &&
          pixel.y < depth.camera.height)) {
      ++tally.pixels;
      tally.missing += 1.0;
      continue;
    }
    const glm::vec3 normal(camera_from_object.rotation * glm::dvec3(surface.normal));
    judgePixel(SurfaceTexel(normal, static_cast<float>(point.z)),
               measured,
               static_cast<int>(pixel.x),
               static_cast<int>(pixel.y),
               kNormalReach,
               options,
               tally);
  }
  return summarize(tally, options, 1.0, visible_mm2);
}

}  // namespace rangepose::host
