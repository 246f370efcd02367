// Parts that are not quite their CAD model: as castings and machined parts come out of a bin.
#pragma once

#include <cstdint>

#include "geometry/mesh.h"

namespace rangepose {

struct WearOptions {
  double scale = 0.01;           ///< size off by up to this, of its length; 0..0.2
  double edge_mm = 0.5;          ///< sharp edges are rounded by about this radius
  double hole_closed = 0.3;      ///< chance that a small hole is closed (chips, burr, paint)
  double opening_closed = 0.15;  ///< chance that an opening (a pipe's end, a large bore) is closed
  double shiny = 0.3;            ///< chance that one face gives no measurement
  void check() const;            ///< throws Error naming the bad field
};

/// A part as it comes out of the bin.
struct WornPart {
  Mesh mesh;   ///< frame of the CAD model; all surfaces that hide and are hidden
  Mesh shiny;  ///< those of its faces of which no sensor gets light back; may be empty
};

/// Small holes are 2 to 12 % of the part's diameter wide, openings 12 to 60 %. A hole is closed at
/// both ends, an opening at one, by a lid flush with the rim that is seen from both sides. A shiny
/// face is smooth (no bend above 30 degrees) and has 5 to 25 % of the area. What a part has none of
/// doesn't happen to it.
///
/// The same seed gives the same part, bit for bit. What a chance decides, and which hole or face it
/// is, doesn't depend on the other options.
WornPart wornPart(const Mesh& cad, const WearOptions& options, std::uint64_t seed);

}  // namespace rangepose
