#include "eval/virtual_bin.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "sim/scanner.h"

namespace rangepose {
namespace {

/// From the highest point of bin and parts up to the orthographic image plane [mm].
constexpr double kClearance = 100.0;

double topOf(const VirtualBin& bin) {
  const Sphere sphere = boundingSphere(*bin.mesh);
  double top = bin.inner_mm.z;
  for (const Pose& pose : bin.bin_from_object) {
    top = std::max(top, (pose * sphere.center_mm).z + sphere.radius_mm);
  }
  return top;
}

/// Looks straight down from `height_mm` over the middle of the floor; x along the bin's x.
Pose cameraAbove(double height_mm) {
  const glm::dmat3 rotation(
      glm::dvec3(1.0, 0.0, 0.0), glm::dvec3(0.0, -1.0, 0.0), glm::dvec3(0.0, 0.0, -1.0));
  return {rotation, {0.0, 0.0, height_mm}};
}

ScannerOptions scannerOf(const VirtualBin& bin, const BinScanOptions& options) {
  ScannerOptions scanner;
  scanner.orthographic = options.orthographic;
  if (options.orthographic) {
    // The inside of the bin fills the image.
    scanner.pixel_size_mm = options.pixel_mm;
    scanner.width = std::max(8, static_cast<int>(std::lround(bin.inner_mm.x / options.pixel_mm)));
    scanner.height = std::max(8, static_cast<int>(std::lround(bin.inner_mm.y / options.pixel_mm)));
  }
  scanner.tilt_rad = 0.0;
  scanner.sensor = options.sensor;
  scanner.seed = options.seed;
  return scanner;
}

/// Height of the camera over the floor: all of the bin is in the image, and the parts below it.
double heightFor(const VirtualBin& bin, const BinScanOptions& options) {
  const double clear = topOf(bin) + kClearance;
  if (options.orthographic) return clear;
  const BinShape shape{bin.inner_mm};
  return std::max(clear, distanceFor(shape, scannerOf(bin, options)) + 0.5 * bin.inner_mm.z);
}

}  // namespace

void BinScanOptions::check() const {
  RP_CHECK(pixel_mm > 0.0, "bin scan: pixel_mm must be positive");
}

BinScan scanVirtualBin(const VirtualBin& bin,
                       const std::vector<bool>& left,
                       const BinScanOptions& options) {
  options.check();
  RP_CHECK(left.size() == bin.bin_from_object.size(), "bin scan: one flag for each part is needed");
  BinScan scan;
  std::vector<PlacedPart> placed;
  for (std::size_t i = 0; i < left.size(); ++i) {
    if (!left[i]) continue;
    scan.parts.push_back(static_cast<int>(i));
    placed.push_back({0, bin.bin_from_object[i]});
  }
  RP_CHECK(!placed.empty(), "bin scan: no part is left");
  const Pose camera_from_bin = cameraAbove(heightFor(bin, options));
  const Scan seen = scanFrom({*bin.mesh},
                             placed,
                             camera_from_bin,
                             scannerOf(bin, options),
                             surroundingsOf(BinShape{bin.inner_mm}));
  scan.image = seen.image;
  scan.bin = {camera_from_bin, bin.inner_mm};
  for (const PartTruth& truth : seen.truth) {
    scan.truth.push_back(truth.camera_from_object);
    scan.visible_fractions.push_back(truth.visible_fraction);
  }
  return scan;
}

}  // namespace rangepose
