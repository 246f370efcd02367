// Heaps of parts on a table, without physics: each part is lowered onto what lies there already,
// and nudged towards where its centre of mass lies lowest.
#pragma once

#include <cstdint>
#include <vector>

#include "core/pose.h"
#include "geometry/mesh.h"

namespace rangepose {

struct HeapOptions {
  int count = 12;          ///< parts in all, the meshes taking turns
  std::uint64_t seed = 1;  ///< same seed, same heap
  double radius_mm =
      0.0;  ///< of the disc that centres are dropped into; 0: from the parts' size and number
  double cell_mm =
      0.0;  ///< width of a column of the height fields; 0: a hundredth of the largest part's reach
  int drops = 8;          ///< a part falls this often, in any orientation; the lowest centre stays
  int nudges = 200;       ///< small turns and shifts tried then; those that lower the centre stay
  double friction = 0.3;  ///< a shift must lower the centre by this part of its length
  void check() const;     ///< throws Error naming the bad field
};

/// World frame: z up, the table at z = 0, the heap about the z axis.
struct PlacedPart {
  int mesh = 0;  ///< index into the meshes given
  Pose world_from_object;
};

/// Parts in the order in which they fell. No two of them share space, nor do they reach below the
/// table; the gap at a contact is up to about two columns wide. Meshes must be closed.
std::vector<PlacedPart> makeHeap(const std::vector<Mesh>& meshes, const HeapOptions& options);

/// Centre of mass of the inside of a closed mesh [mm].
glm::dvec3 centerOfMass(const Mesh& mesh);

}  // namespace rangepose
