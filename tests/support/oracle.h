// Slow, plain answers to compare the stages with: written from the paper and from definitions, not
// from the stages' code.
#pragma once

#include <array>
#include <cstdint>

#include "core/image.h"
#include "geometry/mesh.h"
#include "stages/reference.h"
#include "stages/scene_channels.h"
#include "stages/search.h"

namespace rangepose::test::oracle {

/// Middle of the nine sorted values; outside of the image the border repeats.
Image<float> median(const Image<float>& range);

/// 1 where a pixel with a range differs from any of its 8 neighbours in the image by more than the
/// threshold.
Image<float> edges(const Image<float>& range, float threshold);

/// Squared distance to the nearest edge pixel of the image [px^2], -1 where there is none.
Image<double> nearestEdgeSquared(const Image<float>& edges);

/// Smallest index of the 4-connected region of each pixel, by flooding; kNoPatch on edges and
/// background.
Image<std::int32_t> patches(const Image<float>& range, const Image<float>& edges);

struct Terms {
  double cover_sum = 0.0;
  double cover_count = 0.0;
  double range_sum = 0.0;
  double range_weight = 0.0;
};

/// The four sums of Eq. 2-6 in double, over all pixels of a tile. `background` is the signed
/// distance outside of the window.
Terms errorTerms(const ReferenceObject& object,
                 int view,
                 const SceneChannels& window,
                 const glm::vec3& translation,
                 const ErrorOptions& options,
                 double background);

/// Distance of a point to a triangle.
double distanceToTriangle(const glm::dvec3& point, const std::array<glm::dvec3, 3>& corners);

/// The face of the mesh nearest to a point.
struct NearestFace {
  double distance_mm = 0.0;
  glm::dvec3 normal{0.0};  ///< unit, of either side
};
NearestFace nearestFace(const Mesh& mesh, const glm::dvec3& point);

}  // namespace rangepose::test::oracle
