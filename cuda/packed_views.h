// The views of an object for the fused search: only pixels that show the object.
#pragma once

#include <vector>

#include "cuda/search_types.h"
#include "stages/reference.h"

namespace rangepose::cuda {

struct PackedViews {
  std::vector<ViewEntry> entries;  ///< one a view
  std::vector<ViewPixel> pixels;   ///< view after view, row by row
  int most_pixels = 0;             ///< of a view
  int most_even_pixels = 0;        ///< of a view's even rows
};

PackedViews packViews(const ReferenceObject& object);

/// Throws Error when an option is out of its bounds.
SearchSetup searchSetup(const ReferenceObject& object, int window_px, const SearchOptions& options);

}  // namespace rangepose::cuda
