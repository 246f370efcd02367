// Better triangles for the flat faces of a mesh.
#pragma once

#include "wear/edge_graph.h"

namespace rangepose {

/// Swaps the diagonals of flat quadrangles until the triangles of flat faces are as little acute as
/// they can be (Delaunay). The surface stays the same. CAD systems fill faces with slivers that
/// turn over as soon as a border moves.
///
/// Needs the graph's normals and edges; the edges are out of date afterwards.
void flipFlatEdges(EdgeGraph& graph);

}  // namespace rangepose
