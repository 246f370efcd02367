// The rough search on the host: all views of an object in a few scene windows (paper Sect. 6).
#pragma once

#include <vector>

#include "stages/reference.h"
#include "stages/scene_channels.h"
#include "stages/search.h"

namespace rangepose::host {

/// The views of an object, packed for the inner loop: planes of floats instead of texels, rows cut
/// to where the object is and padded to whole vectors with pixels that weigh nothing.
class PackedViews {
 public:
  static constexpr int kLanes = 8;

  /// A run of pixels of one row of a tile.
  struct Row {
    int u = 0;       ///< first column in the tile
    int v = 0;       ///< row in the tile
    int offset = 0;  ///< of the first pixel in the planes
    int count = 0;   ///< pixels, a multiple of kLanes
    // What does not depend on the translation.
    float cover_count = 0.0f;   ///< sum of f (Eq. 4)
    float range_weight = 0.0f;  ///< sum of c (Eq. 6)
  };
  struct View {
    int first_row = 0;
    int row_count = 0;
  };

  explicit PackedViews(const ReferenceObject& object);

  const View& view(int index) const { return views_[static_cast<std::size_t>(index)]; }
  const Row* rows(const View& view) const { return rows_.data() + view.first_row; }
  const float* distance() const { return distance_.data(); }
  const float* range() const { return range_.data(); }
  const float* cosine() const { return cosine_.data(); }

 private:
  void pack(const ReferenceObject& object, int index);

  std::vector<View> views_;
  std::vector<Row> rows_;
  std::vector<float> distance_;
  std::vector<float> range_;
  std::vector<float> cosine_;
};

/// The sums of Eq. 2 of every view at its translation (one per view) in one window. The order of
/// the sums is fixed: eight partial sums over the columns of each row, added up at the end.
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
