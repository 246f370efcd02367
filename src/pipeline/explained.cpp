#include "pipeline/explained.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "pipeline/refine.h"

namespace rangepose {
namespace {

constexpr double kMostShared = 0.25;

}  // namespace

ExplainedPixels::ExplainedPixels(const DepthImage& depth, double noise_mm, StageSet& stages)
    : depth_(depth),
      noise_mm_(noise_mm),
      stages_(stages),
      taken_(depth.depth_mm.width(), depth.depth_mm.height(), 0) {}

bool ExplainedPixels::take(const ReferenceObject& object,
                           const Pose& pose,
                           Image<std::uint8_t>& foreground) {
  const int all = std::max(depth_.camera.width, depth_.camera.height);
  const SurfaceWindow window =
      windowAround(depth_.camera, pose * object.center_mm, object.radius_mm, all);
  const Image<SurfaceTexel> surface =
      stages_.renderSurface(object.mesh, depth_.camera, pose, window);
  const double tolerance = 2.0 * toleranceFor(object, noise_mm_);
  std::vector<glm::ivec2> pixels;
  int shared = 0;
  for (int y = 0; y < surface.height(); ++y) {
    for (int x = 0; x < surface.width(); ++x) {
      const glm::ivec2 at(window.x0 + x, window.y0 + y);
      const double model = static_cast<double>(surface.at(x, y).w);
      const double seen = static_cast<double>(depth_.depth_mm.at(at.x, at.y));
      if (!(model > 0.0 && std::abs(model - seen) < tolerance)) continue;
      pixels.push_back(at);
      shared += taken_.at(at.x, at.y) != 0 ? 1 : 0;
    }
  }
  if (shared > kMostShared * static_cast<double>(pixels.size())) return false;
  for (const glm::ivec2& at : pixels) {
    taken_.at(at.x, at.y) = 1;
    foreground.at(at.x, at.y) = 0;
  }
  return true;
}

}  // namespace rangepose
