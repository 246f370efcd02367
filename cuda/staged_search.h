// The search as the paper has it (Sect. 6.3): three programs in turn, for all views of an object in
// one window. A readable reference for the fused search, which does the same in one launch.
#pragma once

#include <cuda_runtime_api.h>

#include <vector>

#include "cuda/buffer.h"
#include "cuda/image_view.h"
#include "cuda/search.h"

namespace rangepose::cuda {

/// What the three programs read.
struct StagedInput {
  const ResidentObject& object;
  ImageView atlas;        ///< float4, as ReferenceTexel
  ImageView range_px;     ///< of the window: float
  ImageView distance_px;  ///< of the window: float
  const SearchSetup& setup;
};

/// One simplex a view, and the images that its sums are made in: size^2 * 21 bytes a view. Owned by
/// the caller, for one object after the other.
class StagedSearch {
 public:
  StagedSearch(int views, int size);

  /// Each program is one launch, or one a level of the reduction; none of them waits.
  void start(const StagedInput& in, float seed_range_px, cudaStream_t stream);
  /// The sums of every view at the candidate of its simplex, into terms(). Views that are done keep
  /// theirs.
  void evaluate(const StagedInput& in, cudaStream_t stream);
  void step(const StagedInput& in, cudaStream_t stream);
  /// One hypothesis a view. All pointers are on the device.
  void answer(int window, Hypothesis* answers, cudaStream_t stream) const;

  /// start, then evaluate and step until every simplex is done, then answer. Waits for the device
  /// every few steps: only it knows how many are needed.
  void search(const StagedInput& in,
              float seed_range_px,
              int window,
              Hypothesis* answers,
              cudaStream_t stream);

  SimplexState* states() const { return states_.data(); }
  const ErrorTerms* terms() const { return levels_.back().data(); }

 private:
  void check(const StagedInput& in) const;

  int views_;
  int size_;
  Buffer<SimplexState> states_;
  std::vector<Buffer<ErrorTerms>> levels_;
  Buffer<int> running_;
  PinnedBuffer<int> running_here_;
};

/// One step of each state with a given value (all on the device): for replays.
void simplexSteps(SimplexState* states,
                  const float* values,
                  int count,
                  const SimplexOptions& options,
                  cudaStream_t stream);

}  // namespace rangepose::cuda
