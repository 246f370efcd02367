#include "cuda/stage_set_cuda.h"

#include "core/error.h"
#include "cuda/check.h"
#include "cuda/foreground_cuda.h"
#include "cuda/refine_cuda.h"
#include "cuda/scene_cuda.h"
#include "cuda/search_cuda.h"
#include "gles/stage_set_gles.h"

namespace rangepose::cuda {
namespace {

const CudaScene& cudaScene(const ResidentScene& scene) {
  const auto* own = dynamic_cast<const CudaScene*>(&scene);
  RP_CHECK(own != nullptr, "the scene was prepared by another path");
  return *own;
}

const CudaDepth& cudaDepth(const ResidentDepth& depth) {
  const auto* own = dynamic_cast<const CudaDepth*>(&depth);
  RP_CHECK(own != nullptr, "the depth image was uploaded by another path");
  return *own;
}

class CudaStages : public StageSet {
 public:
  CudaStages(gles::Context* context, DeviceImage::Memory memory, bool staged)
      : drawing_(context != nullptr ? gles::makeGlesStages(*context) : makeHostStages()),
        workspace_(context, memory),
        foreground_(workspace_),
        searcher_(workspace_, staged),
        refiner_(workspace_, context),
        context_(context),
        launches_before_(launches()) {}
  CudaStages(const CudaStages&) = delete;
  CudaStages& operator=(const CudaStages&) = delete;
  ~CudaStages() override {
    if (context_ != nullptr) context_->makeCurrentIfPossible();
    try {
      // What is queued reads what goes now.
      workspace_.synchronize();
    } catch (const Error&) {
      // Nothing runs any more where a kernel has failed.
    }
  }

  std::string name() const override { return "cuda"; }
  DeviceWork work() const override {
    return {drawing_->work().draws + refiner_.draws(), launches() - launches_before_};
  }

  Image<float> resample(const DepthImage& image,
                        const Image<std::uint8_t>& keep,
                        const OrthoCamera& camera) override {
    return resampled(workspace_, CudaDepth(image, keep, workspace_), camera);
  }
  Image<float> median(const Image<float>& range) override { return medianOf(workspace_, range); }
  Image<float> edges(const Image<float>& range_px, float threshold_px) override {
    return edgesOf(workspace_, range_px, threshold_px);
  }
  Image<EdtTexel> distanceTexels(const Image<float>& range_px,
                                 const Image<float>& edges,
                                 int passes) override {
    return distanceTexelsOf(workspace_, range_px, edges, passes);
  }
  Image<float> distance(const Image<float>& range_px,
                        const Image<float>& edges,
                        int passes) override {
    return distanceOf(workspace_, range_px, edges, passes);
  }
  Image<std::int32_t> patches(const Image<float>& range_px, const Image<float>& edges) override {
    return patchesOf(workspace_, range_px, edges);
  }
  std::vector<ErrorTerms> errorTerms(const ReferenceObject& object,
                                     const SceneChannels& window,
                                     const std::vector<glm::vec3>& translations_px,
                                     const ErrorOptions& options) override {
    return searcher_.errorTerms(object, *uploadScene(workspace_, window), translations_px, options);
  }
  std::vector<SimplexState> simplexSteps(const std::vector<SimplexState>& states,
                                         const std::vector<float>& values,
                                         const SimplexOptions& options) override {
    return searcher_.simplexSteps(states, values, options);
  }
  Image<SurfaceTexel> renderSurface(const Mesh& mesh,
                                    const Camera& camera,
                                    const Pose& camera_from_object,
                                    const SurfaceWindow& window) override {
    return drawing_->renderSurface(mesh, camera, camera_from_object, window);
  }

  std::unique_ptr<ResidentScene> prepare(const DepthImage& image,
                                         const Image<std::uint8_t>& keep,
                                         const OrthoCamera& camera,
                                         const PixelBox& region,
                                         const ChannelOptions& options) override {
    // Its memory may be taken again at once: what reads it comes first in the stream.
    return prepareScene(workspace_, CudaDepth(image, keep, workspace_), camera, region, options);
  }
  std::unique_ptr<ResidentScene> prepare(const ResidentDepth& depth,
                                         const OrthoCamera& camera,
                                         const PixelBox& region,
                                         const ChannelOptions& options) override {
    return prepareScene(workspace_, cudaDepth(depth), camera, region, options);
  }
  std::unique_ptr<ResidentScene> upload(const SceneChannels& channels) override {
    return uploadScene(workspace_, channels);
  }
  Image<std::int32_t> patches(const ResidentScene& scene) override {
    return patchesOf(workspace_, cudaScene(scene));
  }
  std::vector<Hypothesis> search(const ReferenceObject& object,
                                 const std::vector<const ResidentScene*>& windows,
                                 const std::vector<float>& seed_range_px,
                                 const SearchOptions& options) override {
    std::vector<const CudaScene*> own;
    own.reserve(windows.size());
    for (const ResidentScene* window : windows) own.push_back(&cudaScene(*window));
    return searcher_.search(object, own, seed_range_px, options);
  }

  std::unique_ptr<ResidentDepth> uploadDepth(const DepthImage& depth,
                                             const Image<std::uint8_t>& keep) override {
    return std::make_unique<CudaDepth>(depth, keep, workspace_);
  }
  std::unique_ptr<ResidentForeground> foreground(const DepthImage& measured,
                                                 const ForegroundTask& task) override {
    return foreground_.find(measured, task);
  }
  LateralExtent extent(const ResidentDepth& depth) override {
    return foreground_.extent(cudaDepth(depth));
  }
  std::vector<IcpResult> align(const ResidentDepth& depth,
                               const std::vector<AlignTask>& tasks) override {
    return refiner_.align(cudaDepth(depth), tasks);
  }
  std::vector<CheckResult> judge(const ResidentDepth& depth,
                                 const std::vector<JudgeTask>& tasks) override {
    return refiner_.judge(cudaDepth(depth), tasks);
  }
  std::vector<IcpResult> alignSurfaces(const ResidentDepth& depth,
                                       const std::vector<RenderTask>& tasks) override {
    return refiner_.alignSurfaces(cudaDepth(depth), tasks);
  }
  std::vector<CheckResult> judgeSurfaces(const ResidentDepth& depth,
                                         const std::vector<RenderTask>& tasks) override {
    return refiner_.judgeSurfaces(cudaDepth(depth), tasks);
  }

 private:
  std::unique_ptr<StageSet> drawing_;
  Workspace workspace_;
  ForegroundFinder foreground_;
  Searcher searcher_;
  Refiner refiner_;
  gles::Context* context_;
  std::int64_t launches_before_;
};

}  // namespace

std::unique_ptr<StageSet> makeCudaStages(gles::Context* context, bool shared, bool staged) {
  const auto memory = shared ? DeviceImage::Memory::kShared : DeviceImage::Memory::kOwn;
  return std::make_unique<CudaStages>(context, memory, staged);
}

}  // namespace rangepose::cuda
