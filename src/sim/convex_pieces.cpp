#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "core/error.h"
#include "sim/convex_hull.h"
#include "sim/physics_part.h"

namespace rangepose {
namespace {

/// A part of the surface, cut off by planes.
struct Patch {
  std::vector<glm::dvec3> points;
  std::vector<glm::uvec3> triangles;
  std::vector<std::pair<unsigned, unsigned>> edges;  ///< each once
  ConvexHull hull;
};

struct Cut {
  int axis = 0;
  double at = 0.0;
  double freed = 0.0;  ///< volume of the hull less those of its two halves
};

void finish(Patch& patch) {
  for (const glm::uvec3& t : patch.triangles) {
    for (int k = 0; k < 3; ++k) {
      const unsigned a = t[k];
      const unsigned b = t[(k + 1) % 3];
      patch.edges.emplace_back(std::min(a, b), std::max(a, b));
    }
  }
  std::sort(patch.edges.begin(), patch.edges.end());
  patch.edges.erase(std::unique(patch.edges.begin(), patch.edges.end()), patch.edges.end());
  patch.hull = convexHull(patch.points);
}

glm::dvec3 crossing(const glm::dvec3& a, const glm::dvec3& b, const Cut& cut) {
  const double share = (cut.at - a[cut.axis]) / (b[cut.axis] - a[cut.axis]);
  glm::dvec3 point = a + share * (b - a);
  point[cut.axis] = cut.at;
  return point;
}

/// The side of a cut, without making the patches.
std::vector<glm::dvec3> pointsOfSide(const Patch& patch, const Cut& cut, bool upper) {
  std::vector<glm::dvec3> side;
  for (const glm::dvec3& p : patch.points) {
    if (upper ? p[cut.axis] >= cut.at : p[cut.axis] <= cut.at) side.push_back(p);
  }
  for (const auto& [i, j] : patch.edges) {
    const glm::dvec3& a = patch.points[i];
    const glm::dvec3& b = patch.points[j];
    if ((a[cut.axis] < cut.at) != (b[cut.axis] < cut.at) && a[cut.axis] != b[cut.axis]) {
      side.push_back(crossing(a, b, cut));
    }
  }
  return side;
}

/// Clips the triangles one by one; a cut edge gets one new point for both of its triangles.
class Clipper {
 public:
  Clipper(const Patch& patch, const Cut& cut, bool upper)
      : patch_(patch), cut_(cut), upper_(upper) {}

  Patch run() {
    for (const glm::uvec3& triangle : patch_.triangles) add(triangle);
    finish(result_);
    return std::move(result_);
  }

 private:
  bool keeps(unsigned index) const {
    const double value = patch_.points[index][cut_.axis];
    return upper_ ? value >= cut_.at : value <= cut_.at;
  }
  unsigned point(unsigned a, unsigned b) {
    const auto key = std::minmax(a, b);
    const auto [entry, is_new] =
        new_index_.try_emplace(key, static_cast<unsigned>(result_.points.size()));
    if (is_new) {
      const glm::dvec3& p = patch_.points[key.first];
      const glm::dvec3& q = patch_.points[key.second];
      result_.points.push_back(a == b ? p : crossing(p, q, cut_));
    }
    return entry->second;
  }
  void add(const glm::uvec3& triangle) {
    std::vector<unsigned> polygon;
    for (int k = 0; k < 3; ++k) {
      const unsigned here = triangle[k];
      const unsigned next = triangle[(k + 1) % 3];
      if (keeps(here)) polygon.push_back(point(here, here));
      // A point on the plane belongs to both sides and is no crossing.
      if (keeps(here) != keeps(next)) {
        const unsigned kept = keeps(here) ? here : next;
        if (patch_.points[kept][cut_.axis] != cut_.at) polygon.push_back(point(here, next));
      }
    }
    for (std::size_t k = 1; k + 1 < polygon.size(); ++k) {
      result_.triangles.emplace_back(polygon[0], polygon[k], polygon[k + 1]);
    }
  }

  const Patch& patch_;
  const Cut cut_;
  const bool upper_;
  Patch result_;
  std::map<std::pair<unsigned, unsigned>, unsigned> new_index_;
};

void tryCut(const Patch& patch, Cut cut, Cut& best) {
  const double lower = hullVolume(pointsOfSide(patch, cut, false));
  const double upper = hullVolume(pointsOfSide(patch, cut, true));
  cut.freed = patch.hull.volume - lower - upper;
  if (cut.freed > best.freed) best = cut;
}

/// Along each axis evenly spaced planes, then closer ones about the best.
Cut bestCut(const Patch& patch) {
  constexpr int kPlanes = 11;
  constexpr int kFiner = 3;  // to each side of the best
  glm::dvec3 low = patch.points[0];
  glm::dvec3 high = low;
  for (const glm::dvec3& p : patch.points) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  const glm::dvec3 step = (high - low) / (kPlanes + 1.0);
  Cut best;
  for (int axis = 0; axis < 3; ++axis) {
    for (int k = 1; k <= kPlanes; ++k) tryCut(patch, {axis, low[axis] + k * step[axis]}, best);
  }
  const Cut coarse = best;
  for (int k = -kFiner; k <= kFiner && coarse.freed > 0.0; ++k) {
    const double offset = k * step[coarse.axis] / (kFiner + 1.0);
    if (k != 0) tryCut(patch, {coarse.axis, coarse.at + offset}, best);
  }
  return best;
}

Patch wholeSurface(const Mesh& mesh) {
  Patch patch;
  patch.points.assign(mesh.vertices.begin(), mesh.vertices.end());
  patch.triangles = mesh.triangles;
  finish(patch);
  return patch;
}

ConvexPiece pieceOf(const Patch& patch, const PieceOptions& options, double diameter_mm) {
  const ConvexHull hull =
      simplifiedHull(patch.hull, options.max_vertices, options.detail * diameter_mm);
  ConvexPiece piece{hull.corners, 0.0};
  if (hull.planes.empty()) return piece;
  for (const glm::dvec3& point : patch.points) {
    piece.short_mm = std::max(piece.short_mm, hull.outside(point));
  }
  return piece;
}

}  // namespace

void PieceOptions::check() const {
  RP_CHECK(max_pieces >= 1 && max_pieces <= 256,
           "pieces: max_pieces is " + std::to_string(max_pieces) + ", must be 1 to 256");
  RP_CHECK(max_vertices >= 4 && max_vertices <= 256,
           "pieces: max_vertices is " + std::to_string(max_vertices) + ", must be 4 to 256");
  RP_CHECK(detail >= 0.0 && detail < 0.1, "pieces: detail must be 0 to 0.1");
  RP_CHECK(gain > 0.0 && gain <= 1.0, "pieces: gain must be above 0, at most 1");
}

std::vector<ConvexPiece> convexPieces(const Mesh& mesh, const PieceOptions& options) {
  options.check();
  checkMesh(mesh);
  std::vector<Patch> patches = {wholeSurface(mesh)};
  std::vector<Cut> cuts = {bestCut(patches[0])};
  const double least_mm3 = options.gain * patches[0].hull.volume;
  while (patches.size() < static_cast<std::size_t>(options.max_pieces)) {
    const auto best = std::max_element(
        cuts.begin(), cuts.end(), [](const Cut& a, const Cut& b) { return a.freed < b.freed; });
    if (!(best->freed > least_mm3)) break;
    const auto index = static_cast<std::size_t>(best - cuts.begin());
    Patch lower = Clipper(patches[index], cuts[index], false).run();
    Patch upper = Clipper(patches[index], cuts[index], true).run();
    patches[index] = std::move(lower);
    patches.push_back(std::move(upper));
    cuts[index] = bestCut(patches[index]);
    cuts.push_back(bestCut(patches.back()));
  }
  const double diameter_mm = diameter(mesh);
  std::vector<ConvexPiece> pieces;
  pieces.reserve(patches.size());
  for (const Patch& patch : patches) pieces.push_back(pieceOf(patch, options, diameter_mm));
  return pieces;
}

}  // namespace rangepose
