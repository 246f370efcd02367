// Virtual bins and their scans from straight above (paper Sect. 8.1.1).
#pragma once

#include <cstdint>
#include <vector>

#include "core/camera.h"
#include "core/pose.h"
#include "geometry/mesh.h"
#include "sim/sensor_model.h"

namespace rangepose {

/// Parts of one type in an open bin. Bin frame: origin at the centre of the inner floor, z up.
struct VirtualBin {
  const Mesh* mesh = nullptr;  ///< must outlive the bin
  int number = 0;              ///< for reports
  glm::dvec3 inner_mm{0.0};    ///< x, y, height
  std::vector<Pose> bin_from_object;
};

struct BinScanOptions {
  bool orthographic = true;  ///< as the references; else the sensor's camera over the bin's middle
  double pixel_mm = 0.5;     ///< of the orthographic scan
  SensorModel sensor = sensorModel("none");
  std::uint64_t seed = 1;  ///< of the noise
  void check() const;      ///< throws Error naming the bad field
};

/// What a sensor sees of the parts that are left, and the truth about them.
struct BinScan {
  DepthImage image;
  BinBox bin;
  std::vector<int> parts;                 ///< index into the bin, of each part left
  std::vector<Pose> truth;                ///< camera_from_object of each part left
  std::vector<double> visible_fractions;  ///< of each part left: seen of its silhouette, 0..1
};

/// `left` has a flag for each part of the bin. The bin's walls and floor are seen, too. Throws
/// Error when no part is left.
BinScan scanVirtualBin(const VirtualBin& bin,
                       const std::vector<bool>& left,
                       const BinScanOptions& options);

}  // namespace rangepose
