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

class CudaScenes : public SceneStage {
 public:
  explicit CudaScenes(Workspace& workspace) : workspace_(workspace) {}
  ResidentScenes prepare(const ResidentDepth& depth,
                         const std::vector<WindowTask>& windows,
                         const ChannelOptions& options) override {
    const auto& own = ownImage<CudaDepth>(depth);
    ResidentScenes scenes;
    for (const auto& [camera, region] : windows) {
      scenes.push_back(prepareScene(workspace_, own, camera, region, options));
    }
    return scenes;
  }
  std::unique_ptr<ResidentScene> upload(const SceneChannels& channels) override {
    return uploadScene(workspace_, channels);
  }
  Image<std::int32_t> patches(const ResidentScene& scene) override {
    return patchesOf(workspace_, ownImage<CudaScene>(scene));
  }

 private:
  Workspace& workspace_;
};

class CudaProbe : public StageProbe {
 public:
  CudaProbe(Workspace& workspace, Searcher& searcher, gles::Context* context)
      : workspace_(workspace),
        searcher_(searcher),
        drawing_(context != nullptr ? gles::makeGlesStages(*context) : makeHostStages()) {}

  DeviceWork drawn() const { return drawing_->work(); }

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
    return drawing_->probe->renderSurface(mesh, camera, camera_from_object, window);
  }

 private:
  Workspace& workspace_;
  Searcher& searcher_;
  std::unique_ptr<StageSet> drawing_;
};

struct CudaPath {
  CudaPath(gles::Context* its_context, DeviceImage::Memory memory, bool staged)
      : context(its_context),
        workspace(context, memory),
        foreground(workspace),
        scenes(workspace),
        search(workspace, staged),
        refine(workspace, context),
        probe(workspace, search, context),
        launches_before(launches()) {}
  CudaPath(const CudaPath&) = delete;
  CudaPath& operator=(const CudaPath&) = delete;
  ~CudaPath() {
    if (context != nullptr) context->makeCurrentIfPossible();
    try {
      // What is queued reads what goes now.
      workspace.synchronize();
    } catch (const Error&) {
      // Nothing runs any more where a kernel has failed.
    }
  }

  gles::Context* context;
  Workspace workspace;
  ForegroundFinder foreground;
  CudaScenes scenes;
  Searcher search;
  Refiner refine;
  CudaProbe probe;
  std::int64_t launches_before;
};

}  // namespace

std::unique_ptr<StageSet> makeCudaStages(gles::Context* context, bool shared, bool staged) {
  const auto memory = shared ? DeviceImage::Memory::kShared : DeviceImage::Memory::kOwn;
  const auto path = std::make_shared<CudaPath>(context, memory, staged);
  std::unique_ptr<StageSet> set =
      stageSetOf("cuda", context != nullptr ? "" : "drawing of surfaces", path);
  set->work = [path] {
    return DeviceWork{path->probe.drawn().draws + path->refine.draws(),
                      launches() - path->launches_before};
  };
  return set;
}

}  // namespace rangepose::cuda
