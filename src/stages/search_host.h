// The rough search on the host: all views of an object in a few scene windows (paper Sect. 6).
#pragma once

#include <vector>

#include "stages/reference.h"
#include "stages/scene_channels.h"
#include "stages/search.h"

namespace rangepose::host {

/// The views of an object, packed for the inner loop: planes of floats instead of texels, rows cut to where
/// the object is and padded to whole vectors.
class PackedViews {
 public:
  explicit PackedViews(const ReferenceObject& object);

  struct Row {
    int v = 0;           ///< row in the tile
    int u = 0;           ///< first column in the tile
    int offset = 0;      ///< of the first pixel in the planes
    int count = 0;       ///< pixels, a multiple of kLanes
  };
  struct View {
    int first_row = 0;
    int row_count = 0;
    float cover_count = 0.0f;   ///< sum of f
    float range_weight = 0.0f;  ///< sum of c
    float area_factor = 1.0f;   ///< unused until a search sets its form
  };
  static constexpr int kLanes = 8;

  const std::vector<View>& views() const { return views_; }
  const std::vector<Row>& rows() const { return rows_; }
  const float* distance() const { return distance_.data(); }
  const float* range() const { return range_.data(); }
  const float* cosine() const { return cosine_.data(); }

 private:
  std::vector<View> views_;
  std::vector<Row> rows_;
  std::vector<float> distance_;
  std::vector<float> range_;
  std::vector<float> cosine_;
};

/// The sums of Eq. 2 of every view at its translation (one per view) in one window.
std::vector<ErrorTerms> errorTerms(const ReferenceObject& object,
                                   const PackedViews& packed,
                                   const SceneChannels& window,
                                   const std::vector<glm::vec3>& translations_px,
                                   const ErrorOptions& options);

/// One hypothesis for every view and window, ordered by window, then view.
/// `seed_range_px[w]` is the range at the centre of window w.
std::vector<Hypothesis> search(const ReferenceObject& object,
                               const PackedViews& packed,
                               const std::vector<const SceneChannels*>& windows,
                               const std::vector<float>& seed_range_px,
                               const SearchOptions& options);

}  // namespace rangepose::host
