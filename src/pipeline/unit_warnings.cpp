#include "pipeline/unit_warnings.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace rangepose {

std::vector<std::string> unitWarnings(const DepthImage& depth, const ReferenceDatabase& database) {
  std::vector<float> depths;
  std::copy_if(
      depth.depth_mm.begin(), depth.depth_mm.end(), std::back_inserter(depths), [](float mm) {
        return mm > 0.0f;
      });
  const auto middle = depths.begin() + static_cast<std::ptrdiff_t>(depths.size() / 2);
  std::nth_element(depths.begin(), middle, depths.end());
  const double spacing = depth.camera.pixelSpacingMm(static_cast<double>(*middle));
  const double image_mm = spacing * std::max(depth.camera.width, depth.camera.height);
  std::vector<std::string> warnings;
  for (const ReferenceObject& object : database.objects) {
    const double pixels = object.diameter_mm / spacing;
    // Either way nothing would be found, and a wrong power of ten is the likely reason.
    constexpr double kFewestPx = 12.0;
    if (pixels >= kFewestPx && object.diameter_mm <= image_mm) continue;
    warnings.push_back(
        "object " + object.mesh.name + " is " + std::to_string(std::lround(object.diameter_mm)) +
        " mm wide and the image " + std::to_string(std::lround(image_mm)) +
        " mm: check --unit of `rangepose build`, depth_scale and the unit of the cloud");
  }
  return warnings;
}

}  // namespace rangepose
