#include "peers/verdict.h"

#include "pipeline/candidates.h"
#include "stages/check_host.h"

namespace rangepose::peers {

const ReferenceObject& Verdict::objectOf(const Candidate& candidate) const {
  return database_.objects[static_cast<std::size_t>(candidate.object)];
}

CheckResult Verdict::checked(const Candidate& candidate,
                             const CheckOptions& options,
                             int pixels) const {
  const ReferenceObject& object = objectOf(candidate);
  const SurfaceWindow window =
      wholeWindowAround(depth_.camera, candidate.pose * object.center_mm, object.radius_mm, pixels);
  const Image<SurfaceTexel> surface =
      host::renderSurface(object.mesh, depth_.camera, candidate.pose, window);
  return host::check(
      surface, window, depth_, {candidate.pose * object.center_mm, object.radius_mm}, options);
}

void Verdict::judge(Candidate& candidate) const {
  constexpr int kPixels = 112;
  const ReferenceObject& object = objectOf(candidate);
  const CheckOptions options = checkOptionsFor(object, noise_mm_);
  candidate.outside = enclosure_.outsideShare(candidate.object, candidate.pose);
  setEvidence(candidate, checked(candidate, options, kPixels), meanVisibleArea(object));
}

void Verdict::glance(Candidate& candidate) const {
  constexpr int kPixels = 32;
  const ReferenceObject& object = objectOf(candidate);
  CheckOptions options = glanceOptionsFor(object, noise_mm_);
  options.border = 0.0;  // an outline is not met by a rough pose
  setVerdict(candidate, checked(candidate, options, kPixels), meanVisibleArea(object));
}

Cloud Verdict::visible(const Candidate& candidate, double reach_mm, int count) const {
  constexpr int kPixels = 112;
  const ReferenceObject& object = objectOf(candidate);
  const Pose& pose = candidate.pose;
  const SurfaceWindow window =
      windowAround(depth_.camera, pose * object.center_mm, object.radius_mm, kPixels);
  if (window.width == 0) return {};
  Image<SurfaceTexel> surface = host::renderSurface(object.mesh, depth_.camera, pose, window);
  for (int y = 0; y < surface.height(); ++y) {
    for (int x = 0; x < surface.width(); ++x) {
      const int u = window.x0 + x * window.step;
      const int v = window.y0 + y * window.step;
      if (!depth_.depth_mm.contains(u, v)) continue;
      const double seen = static_cast<double>(depth_.depth_mm.at(u, v));
      SurfaceTexel& texel = surface.at(x, y);
      if (seen > 0.0 && seen < static_cast<double>(texel.w) - reach_mm) texel.w = 0.0f;
    }
  }
  return pointsOfSurface(surface, depth_.camera, window, pose, count);
}

}  // namespace rangepose::peers
