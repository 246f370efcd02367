#include "eval/jump_profiles.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace rangepose {
namespace {

/// Of the bell that smooths the silhouette, from which the contour and its normal are taken [px].
constexpr double kSmoothPx = 1.5;
constexpr int kSmoothReachPx = 4;

/// What lies outside is judged by these [px].
constexpr int kOutsideFromPx = 6;
constexpr int kOutsideToPx = 14;
constexpr int kLeastNear = 3;     ///< of 7
constexpr int kLeastOutside = 5;  ///< of 9
/// Between the quartiles of what is measured at the far level, and between its line's ends, as a
/// share of the jump: no more.
constexpr double kFarSpread = 0.25;

/// Of the values, by counting; the upper one of two in the middle.
double quantile(std::vector<double>& values, double share) {
  const auto at = static_cast<std::size_t>(share * static_cast<double>(values.size()));
  const auto place = values.begin() + static_cast<std::ptrdiff_t>(std::min(at, values.size() - 1));
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

/// Follows profiles through one image.
class Profiler {
 public:
  Profiler(const DepthImage& image, const KnownSurface& known, const std::vector<KnownPart>& parts)
      : image_(image), known_(known), parts_(parts) {}

  std::optional<JumpProfile> at(int u, int v) const {
    JumpProfile profile;
    profile.part = known_.at(u, v).part;
    if (profile.part < 0 || !part(profile).counted || !onContour(u, v)) return {};
    if (!findContour(u, v, profile) || !sample(profile)) return {};
    if (!findNear(profile) || !findFar(profile)) return {};
    return profile;
  }

 private:
  const KnownPart& part(const JumpProfile& profile) const {
    return parts_[static_cast<std::size_t>(profile.part)];
  }
  glm::ivec2 pixelAt(const JumpProfile& profile, int place_px) const {
    const glm::dvec2 at = profile.contour_px + static_cast<double>(place_px) * profile.outward;
    return {static_cast<int>(std::lround(at.x)), static_cast<int>(std::lround(at.y))};
  }
  bool isPart(int u, int v, int index) const {
    return known_.contains(u, v) && known_.at(u, v).part == index;
  }

  /// Beside a pixel that shows nothing known, or a part behind.
  bool onContour(int u, int v) const {
    const KnownPixel& here = known_.at(u, v);
    for (const glm::ivec2& step : {glm::ivec2(-1, 0), {1, 0}, {0, -1}, {0, 1}}) {
      if (!known_.contains(u + step.x, v + step.y)) continue;
      const KnownPixel& near = known_.at(u + step.x, v + step.y);
      if (near.part < 0 || (near.part != here.part && near.depth_mm > here.depth_mm)) return true;
    }
    return false;
  }

  /// The smoothed silhouette passes one half at the contour, at right angles to it.
  bool findContour(int u, int v, JumpProfile& profile) const {
    double value = 0.0;
    double weights = 0.0;
    glm::dvec2 slope(0.0);
    for (int y = -kSmoothReachPx; y <= kSmoothReachPx; ++y) {
      for (int x = -kSmoothReachPx; x <= kSmoothReachPx; ++x) {
        const double weight = std::exp(-0.5 * (x * x + y * y) / (kSmoothPx * kSmoothPx));
        weights += weight;
        if (!isPart(u + x, v + y, profile.part)) continue;
        value += weight;
        slope += weight / (kSmoothPx * kSmoothPx) * glm::dvec2(x, y);
      }
    }
    const double steep = glm::length(slope) / weights;
    // Half of that of a straight contour: a thin or a ragged place has no normal.
    if (steep * kSmoothPx < 0.2) return false;
    profile.outward = -glm::normalize(slope);
    profile.contour_px = glm::dvec2(u, v) + (value / weights - 0.5) / steep * profile.outward;
    return true;
  }

  /// False where the profile leaves the image.
  bool sample(JumpProfile& profile) const {
    for (int step = 0; step < kProfileSteps; ++step) {
      const glm::ivec2 pixel = pixelAt(profile, step - kProfileInsidePx);
      if (!known_.contains(pixel.x, pixel.y)) return false;
      const auto i = static_cast<std::size_t>(step);
      profile.measured_mm[i] = image_.depth_mm.at(pixel.x, pixel.y);
      profile.place_px[i] = glm::dot(glm::dvec2(pixel) - profile.contour_px, profile.outward);
    }
    return true;
  }

  /// Depth of the part along the profile; false where the data does not show it.
  bool findNear(JumpProfile& profile) const {
    std::vector<double> off;
    double rim_mm = 0.0;
    for (int place = -kProfileInsidePx; place <= kProfileOutsidePx; ++place) {
      const glm::ivec2 pixel = pixelAt(profile, place);
      const KnownPixel& known = known_.at(pixel.x, pixel.y);
      const auto i = static_cast<std::size_t>(profileStepAt(place));
      if (place <= 0 && known.part == profile.part) rim_mm = known.depth_mm;
      profile.near_mm[i] = rim_mm;
      if (place > kNearLevelPx || known.part != profile.part) continue;
      if (profile.measured_mm[i] == 0.0f) continue;
      const double error = static_cast<double>(profile.measured_mm[i]) - known.depth_mm;
      if (std::abs(error) * known.cosine <= agreementMm(part(profile))) off.push_back(error);
    }
    if (off.size() < kLeastNear) return false;
    const double common = quantile(off, 0.5);
    for (double& near : profile.near_mm) near += common;
    return true;
  }

  /// What lies behind; false where nothing does, or it is not known to.
  bool findFar(JumpProfile& profile) const {
    const double behind = profile.near_mm.back() + kJumpMm;
    std::vector<double> outside;
    std::vector<glm::dvec2> far;
    for (int place = 2; place <= kProfileOutsidePx; ++place) {
      const glm::ivec2 pixel = pixelAt(profile, place);
      const KnownPixel& known = known_.at(pixel.x, pixel.y);
      if (known.part >= 0 && known.depth_mm < behind) return false;
      const auto i = static_cast<std::size_t>(profileStepAt(place));
      const double measured = profile.measured_mm[i];
      if (measured == 0.0) continue;
      if (place >= kOutsideFromPx && place <= kOutsideToPx) outside.push_back(measured);
      if (place >= kFarLevelPx) far.emplace_back(profile.place_px[i], measured);
    }
    if (outside.size() < kLeastOutside || far.size() < kLeastOutside) return false;
    return quantile(outside, 0.5) >= behind && layFar(far, profile);
  }

  /// False where what lies behind is nearer than it must be, or of several depths.
  static bool layFar(const std::vector<glm::dvec2>& far, JumpProfile& profile) {
    std::vector<double> places;
    std::vector<double> depths;
    std::vector<double> slopes;
    for (std::size_t i = 0; i < far.size(); ++i) {
      places.push_back(far[i].x);
      depths.push_back(far[i].y);
      for (std::size_t j = 0; j < i; ++j) {
        const glm::dvec2 between = far[i] - far[j];
        if (between.x > 1.0) slopes.push_back(between.y / between.x);
      }
    }
    const double slope = quantile(slopes, 0.5);
    const double level = quantile(depths, 0.5);
    const double jump = level - profile.near_mm.back();
    if (jump < kJumpMm || quantile(depths, 0.75) - quantile(depths, 0.25) > kFarSpread * jump) {
      return false;
    }
    const double middle = quantile(places, 0.5);
    const double most = kFarSpread * jump;
    for (std::size_t i = 0; i < profile.far_mm.size(); ++i) {
      const double along = std::max(0.0, profile.place_px[i]) - middle;
      profile.far_mm[i] = level + std::clamp(slope * along, -most, most);
    }
    return true;
  }

  const DepthImage& image_;
  const KnownSurface& known_;
  const std::vector<KnownPart>& parts_;
};

}  // namespace

ContourSide JumpProfile::side() const {
  if (std::abs(outward.x) >= std::abs(outward.y)) {
    return outward.x < 0.0 ? ContourSide::kLeft : ContourSide::kRight;
  }
  return outward.y < 0.0 ? ContourSide::kTop : ContourSide::kBottom;
}

double JumpProfile::fraction(int step) const {
  const auto i = static_cast<std::size_t>(step);
  if (measured_mm[i] == 0.0f) return std::numeric_limits<double>::quiet_NaN();
  return (measured_mm[i] - near_mm[i]) / (far_mm[i] - near_mm[i]);
}

std::vector<JumpProfile> jumpProfiles(const DepthImage& image,
                                      const KnownSurface& known,
                                      const std::vector<KnownPart>& parts) {
  const Profiler profiler(image, known, parts);
  std::vector<JumpProfile> profiles;
  for (int v = 0; v < known.height(); ++v) {
    for (int u = 0; u < known.width(); ++u) {
      if (const auto profile = profiler.at(u, v)) profiles.push_back(*profile);
    }
  }
  return profiles;
}

}  // namespace rangepose
