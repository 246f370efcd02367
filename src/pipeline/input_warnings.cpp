#include "pipeline/input_warnings.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/parallel.h"
#include "pipeline/enclosure.h"

namespace rangepose {

std::vector<std::string> unitWarnings(const DepthImage& depth, const ReferenceDatabase& database) {
  // A unit is wrong by a factor of ten or more: a few of the pixels tell.
  constexpr std::size_t kOneOf = 16;
  std::vector<float> depths;
  std::size_t measured = 0;
  for (const float mm : depth.depth_mm) {
    if (mm > 0.0f && measured++ % kOneOf == 0) depths.push_back(mm);
  }
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

std::vector<std::string> binWarnings(const DepthImage& depth,
                                     const BinBox& bin,
                                     const ReferenceDatabase& database) {
  constexpr double kMuch = 0.02;  // of the pixels between the walls
  constexpr int kRowsPerPiece = 16;
  double smallest_mm = std::numeric_limits<double>::max();
  for (const ReferenceObject& object : database.objects)
    smallest_mm = std::min(smallest_mm, object.diameter_mm);
  const double margin_mm = kEnclosureMargin * smallest_mm;
  const Pose bin_from_camera = bin.camera_from_bin.inverse();
  struct Row {
    std::size_t between = 0;
    std::vector<double> under_mm;
  };
  std::vector<Row> rows(static_cast<std::size_t>(depth.depth_mm.height()));
  parallelForEach(rows.size(), kRowsPerPiece, [&](std::size_t i) {
    const int v = static_cast<int>(i);
    for (int u = 0; u < depth.depth_mm.width(); ++u) {
      const double z_mm = static_cast<double>(depth.depth_mm.at(u, v));
      if (!(z_mm > 0.0)) continue;
      const glm::dvec3 point = bin_from_camera * depth.camera.unproject(u, v, z_mm);
      if (std::abs(point.x) > 0.5 * bin.inner_size_mm.x) continue;
      if (std::abs(point.y) > 0.5 * bin.inner_size_mm.y) continue;
      ++rows[i].between;
      if (-point.z > margin_mm) rows[i].under_mm.push_back(-point.z);
    }
  });
  std::vector<double> under_mm;
  std::size_t between = 0;
  for (const Row& row : rows) {
    between += row.between;
    under_mm.insert(under_mm.end(), row.under_mm.begin(), row.under_mm.end());
  }
  if (under_mm.size() == between) {
    return {"no measured pixel lies in the bin: check that cam_t_bin2c and inner_size are in mm"};
  }
  const double share = static_cast<double>(under_mm.size()) / static_cast<double>(between);
  if (share < kMuch) return {};
  const auto middle = under_mm.begin() + static_cast<std::ptrdiff_t>(under_mm.size() / 2);
  std::nth_element(under_mm.begin(), middle, under_mm.end());
  return {std::to_string(std::lround(100.0 * share)) +
          " % of the pixels between the bin's walls are under its floor, by " +
          std::to_string(std::lround(*middle)) +
          " mm in the middle: no part is found there; check cam_t_bin2c"};
}

}  // namespace rangepose
