// Rendered depth images of one part in a known pose, with and without noise and a ball that hides
// some of it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/camera.h"
#include "geometry/mesh.h"

namespace rangepose {

struct PoseTrial {
  DepthImage image;
  Pose camera_from_object;
  double hidden =
      0.0;  ///< share of the part's measured pixels that the ball and its shadow take away
};

/// The part floats in a random orientation (uniform over SO(3), anywhere near the middle of the
/// image) above a table, seen by the scanner of src/sim. `sensor` by its name. With
/// `hidden` > 0 a ball above the part is pushed into the line of sight from a random side until it
/// and its shadow take that share (+-0.03).
PoseTrial makePoseTrial(const Mesh& mesh,
                        std::uint64_t seed,
                        const std::string& sensor,
                        double hidden);

}  // namespace rangepose
