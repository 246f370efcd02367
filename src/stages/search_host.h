// The rough search on the host: all views of an object in a few scene windows (paper Sect. 6).
#pragma once

#include <vector>

#include "stages/reference.h"
#include "stages/scene_channels.h"
#include "stages/search.h"

namespace rangepose::host {

/// The views of an object, packed for the inner loop: planes of floats instead of texels, rows cut
/// to where the object is and padded to whole blocks with pixels that weigh nothing. The blocks of
/// a view are one list: a loop over rows would end at another block in each.
class PackedViews {
 public:
  static constexpr int kLanes = 8;

  /// kLanes pixels of one row of a tile.
  struct Block {
    int u;       ///< first column in the tile
    int v;       ///< row in the tile
    int offset;  ///< of the first pixel in the planes
  };
  /// Some rows of a view, from top to bottom.
  struct Rows {
    std::vector<Block> blocks;
    // What does not depend on the translation.
    float cover_count = 0.0f;   ///< sum of f (Eq. 4)
    float range_weight = 0.0f;  ///< sum of c (Eq. 6)
  };

  explicit PackedViews(const ReferenceObject& object);

  /// All of a view, or with a step of 2 every other row of its tile.
  const Rows& rows(int view, int row_step) const {
    return (row_step == 1 ? all_ : every_other_)[static_cast<std::size_t>(view)];
  }
  const float* distance() const { return distance_.data(); }
  const float* range() const { return range_.data(); }
  const float* cosine() const { return cosine_.data(); }

 private:
  void pack(const ReferenceObject& object, int index);

  std::vector<Rows> all_;          ///< by view
  std::vector<Rows> every_other_;  ///< by view
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
