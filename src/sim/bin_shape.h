// An open bin: a floor and four walls.
#pragma once

#include "core/camera.h"
#include "geometry/mesh.h"

namespace rangepose {

/// Its frame: origin at the centre of the inner floor, x and y along the sides, z up out of the
/// bin.
struct BinShape {
  glm::dvec3 inner_mm{0.0};  ///< x, y, height
};

/// Of floor and walls [mm].
double binThickness(const BinShape& bin);

/// Floor and walls with their thickness, inside, outside and rim, closed; bin frame.
Mesh binMesh(const BinShape& bin);

/// The bin as the region of interest that an estimate is given.
inline BinBox binBox(const BinShape& bin, const Pose& camera_from_bin) {
  return {camera_from_bin, bin.inner_mm};
}

}  // namespace rangepose
