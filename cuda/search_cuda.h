// The search, fused or staged, with what it needs kept on the device from call to call.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "core/kept.h"
#include "cuda/scene_cuda.h"
#include "cuda/search.h"
#include "cuda/staged_search.h"

namespace rangepose::cuda {

class Searcher : public SearchStage {
 public:
  /// `staged`: the paper's three programs in turn, over the atlas as it is; else one kernel over
  /// the views' pixels.
  Searcher(Workspace& workspace, bool staged) : workspace_(workspace), staged_(staged) {}

  std::vector<Hypothesis> search(const ReferenceObject& object,
                                 const std::vector<const ResidentScene*>& windows,
                                 const std::vector<float>& seed_range_px,
                                 const SearchOptions& options) override;
  /// Contract of StageProbe::errorTerms.
  std::vector<ErrorTerms> errorTerms(const ReferenceObject& object,
                                     const CudaScene& window,
                                     const std::vector<glm::vec3>& translations_px,
                                     const ErrorOptions& options);

  /// Contract of StageProbe::simplexSteps.
  std::vector<SimplexState> simplexSteps(const std::vector<SimplexState>& states,
                                         const std::vector<float>& values,
                                         const SimplexOptions& options);

 private:
  struct Known {
    ResidentObject object;
    // Of the staged search.
    std::optional<DeviceImage> atlas;
    std::optional<StagedSearch> programs;
  };
  std::shared_ptr<Known> known(const ReferenceObject& object, cudaStream_t stream);
  Known upload(const ReferenceObject& object, cudaStream_t stream);
  /// All windows with background around them, one after the other.
  void frameWindows(const std::vector<const CudaScene*>& windows,
                    const WindowFrame& frame,
                    float outside_distance,
                    cudaStream_t stream);
  /// `work(input)` with the atlas and the window mapped.
  template <typename Work>
  void withStaged(Known& known,
                  const CudaScene& window,
                  const SearchSetup& setup,
                  cudaStream_t stream,
                  const Work& work);

  Workspace& workspace_;
  bool staged_;
  Kept<std::uint64_t, Known> objects_{kObjectsKept};
  Buffer<WindowTexel> windows_;
  Buffer<float> seeds_;
  Buffer<Hypothesis> answers_;
  Buffer<glm::vec3> translations_;
  Buffer<ErrorTerms> terms_;
  Buffer<SimplexState> states_;
  Buffer<float> values_;
};

}  // namespace rangepose::cuda
