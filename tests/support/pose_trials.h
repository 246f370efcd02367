// Rendered depth images of one part in a known pose, with and without noise and a ball that hides
// some of it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/camera.h"
#include "geometry/mesh.h"

namespace rangepose::test {

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

/// Rotations about the object's origin frame that leave a part of models/ the same, the identity
/// first. Names as in models/: t_pipe, bolt, elbow, bracket.
std::vector<Pose> symmetriesOf(const std::string& part, const Mesh& mesh);

/// Mean distance of the vertices in two poses, the smallest over the symmetries [mm] (the paper's
/// vertex error).
double vertexError(const Mesh& mesh,
                   const std::vector<Pose>& symmetries,
                   const Pose& estimate,
                   const Pose& truth);

}  // namespace rangepose::test
