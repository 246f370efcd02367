// Parts dropped into an open bin by rigid-body simulation until they lie still (paper Sect. 4.2).
#pragma once

#include <cstdint>
#include <vector>

#include "core/pose.h"
#include "sim/bin_shape.h"
#include "sim/heap.h"
#include "sim/physics_part.h"

namespace rangepose {

struct DropOptions {
  std::uint64_t seed = 1;      ///< same seed, same bin, to the last bit, on one build
  BinShape bin;                ///< a side of 0 is chosen for the parts, see binFor()
  double friction = 0.36;      ///< of moving parts, between parts and between parts and bin
  double rest_friction = 0.7;  ///< likewise, once all have fallen: what lies sticks better
  int attempts = 4;          ///< bins tried with seeds derived from `seed` until all parts lie well
  double max_depth = 0.008;  ///< parts may share space this deep, of the diameter
  double max_motion = 0.005;  ///< in a further half second, of the diameter
  double linger_s = 0.0;      ///< gives the bin this much simulated time later
  double time_limit_s = 8.0;  ///< simulated time for the parts to come to rest
  void check() const;         ///< throws Error naming the bad field
};

struct DroppedBin {
  BinShape bin;
  /// In the order in which they fell; `mesh` is the index into the parts, the world is the bin.
  std::vector<PlacedPart> parts;
  double depth_mm = 0.0;   ///< the deepest that two parts, or a part and the bin, share space
  double motion_mm = 0.0;  ///< the farthest a point of a part moves in the half second after this
  int attempts = 1;        ///< the bin that was taken
};

/// A bin that holds counts[k] of parts[k] about one and a half layers deep. Where `wanted` has a
/// side, that one is kept.
BinShape binFor(const std::vector<PhysicsPart>& parts,
                const std::vector<int>& counts,
                const BinShape& wanted = {});

/// Drops counts[k] of parts[k], mixed, each turned at random, in layers. A bin in which a part
/// still moves, reaches beyond the rim or into another is thrown away and another tried; throws
/// Error when all attempts fail: the bin is too small. A height that is chosen here grows with the
/// heap. May run in several threads at the same time; the result does not depend on what others do.
DroppedBin dropParts(const std::vector<PhysicsPart>& parts,
                     const std::vector<int>& counts,
                     const DropOptions& options);

}  // namespace rangepose
