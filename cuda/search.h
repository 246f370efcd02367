// The fused search: all views of an object in all windows in one launch (paper Sect. 6).
#pragma once

#include <cuda_runtime_api.h>

#include <cstdint>

#include "cuda/buffer.h"
#include "cuda/image_view.h"
#include "cuda/search_types.h"
#include "stages/reference.h"

namespace rangepose::cuda {

/// An object's packed views on the device.
class ResidentObject {
 public:
  ResidentObject(const ReferenceObject& object, cudaStream_t stream);

  int views() const { return static_cast<int>(entries_.size()); }
  /// Of the view that shows most, every `row_step`-th row of it [px].
  int mostPixels(int row_step) const { return row_step == 2 ? most_even_pixels_ : most_pixels_; }
  /// Of what lies outside of a window [px].
  float outsideDistance() const { return outside_distance_; }
  const ViewEntry* entries() const { return entries_.data(); }
  const ViewPixel* pixels() const { return pixels_.data(); }

 private:
  int most_pixels_;
  int most_even_pixels_;
  float outside_distance_;
  Buffer<ViewEntry> entries_;
  Buffer<ViewPixel> pixels_;
};

/// Copies a window (range and distance: float [px]) into `into`, frame.texels() texels, with
/// background around it.
void frameWindow(ImageView range_px,
                 ImageView distance_px,
                 float outside_distance,
                 const WindowFrame& frame,
                 WindowTexel* into,
                 cudaStream_t stream);

/// One hypothesis a view and window, ordered by window, then view, into `answers`. `windows` holds
/// `window_count` framed windows one after the other, seed_range_px[w] the range at the centre of
/// each. All pointers are on the device. Nothing waits, nothing is allocated.
void search(const ResidentObject& object,
            const SearchSetup& setup,
            const WindowTexel* windows,
            const float* seed_range_px,
            int window_count,
            Hypothesis* answers,
            cudaStream_t stream);

/// The sums of Eq. 2 of every view at its translation [px], one a view, in one framed window: what
/// the fused search adds up.
void errorTerms(const ResidentObject& object,
                const SearchSetup& setup,
                const WindowTexel* window,
                const glm::vec3* translations_px,
                ErrorTerms* terms,
                cudaStream_t stream);

}  // namespace rangepose::cuda
