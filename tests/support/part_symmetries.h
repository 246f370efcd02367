// The symmetries of the parts of models/ as their descriptions name them, and an error that
// forgives them: independent of the symmetries that are found from the mesh.
#pragma once

#include <string>
#include <vector>

#include "core/pose.h"
#include "geometry/mesh.h"

namespace rangepose::test {

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
