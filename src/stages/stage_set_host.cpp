#include <utility>

#include "core/kept.h"
#include "core/parallel.h"
#include "stages/channels_host.h"
#include "stages/refine_host.h"
#include "stages/resample_host.h"
#include "stages/search_host.h"
#include "stages/stage_set.h"

namespace rangepose {
namespace {

class HostScene : public ResidentScene {
 public:
  explicit HostScene(SceneChannels its_channels) : channels(std::move(its_channels)) {}
  const OrthoCamera& camera() const override { return channels.camera; }
  SceneChannels download() const override { return channels; }

  const SceneChannels channels;
};

class HostScenes : public SceneStage {
 public:
  ResidentScenes prepare(const ResidentDepth& depth,
                         const std::vector<WindowTask>& windows,
                         const ChannelOptions& options) override {
    const auto& own = ownImage<HostDepth>(depth);
    ResidentScenes scenes(windows.size());
    parallelForEach(windows.size(), 1, [&](std::size_t i) {
      const auto& [camera, region] = windows[i];
      scenes[i] = upload(
          host::channels(camera, host::resample(own.depth, own.keep, camera, region), options));
    });
    return scenes;
  }
  std::unique_ptr<ResidentScene> upload(const SceneChannels& channels) override {
    return std::make_unique<HostScene>(channels);
  }
  Image<std::int32_t> patches(const ResidentScene& scene) override {
    const SceneChannels& channels = ownImage<HostScene>(scene).channels;
    return host::patches(channels.range_px, channels.edges);
  }
};

class HostSearch : public SearchStage {
 public:
  std::vector<Hypothesis> search(const ReferenceObject& object,
                                 const std::vector<const ResidentScene*>& windows,
                                 const std::vector<float>& seed_range_px,
                                 const SearchOptions& options) override {
    std::vector<const SceneChannels*> channels;
    channels.reserve(windows.size());
    for (const ResidentScene* window : windows) {
      channels.push_back(&ownImage<HostScene>(*window).channels);
    }
    return host::search(object, *packed(object), channels, seed_range_px, options);
  }

  std::shared_ptr<const host::PackedViews> packed(const ReferenceObject& object) {
    return packed_.of(object.serial, [&] { return host::PackedViews(object); });
  }

 private:
  Kept<std::uint64_t, host::PackedViews> packed_{kObjectsKept};
};

class HostProbe : public StageProbe {
 public:
  explicit HostProbe(HostSearch& search) : search_(search) {}

  Image<float> resample(const DepthImage& image,
                        const Image<std::uint8_t>& keep,
                        const OrthoCamera& camera) override {
    return host::resample(image, keep, camera);
  }
  Image<float> median(const Image<float>& range) override { return host::median(range); }
  Image<float> edges(const Image<float>& range_px, float threshold_px) override {
    return host::edges(range_px, threshold_px);
  }
  Image<EdtTexel> distanceTexels(const Image<float>& range_px,
                                 const Image<float>& edges,
                                 int passes) override {
    return host::distanceTexels(range_px, edges, passes);
  }
  Image<float> distance(const Image<float>& range_px,
                        const Image<float>& edges,
                        int passes) override {
    return host::distance(range_px, edges, passes);
  }
  Image<std::int32_t> patches(const Image<float>& range_px, const Image<float>& edges) override {
    return host::patches(range_px, edges);
  }
  std::vector<ErrorTerms> errorTerms(const ReferenceObject& object,
                                     const SceneChannels& window,
                                     const std::vector<glm::vec3>& translations_px,
                                     const ErrorOptions& options) override {
    return host::errorTerms(object, *search_.packed(object), window, translations_px, options);
  }
  std::vector<SimplexState> simplexSteps(const std::vector<SimplexState>& states,
                                         const std::vector<float>& values,
                                         const SimplexOptions& options) override {
    RP_CHECK(states.size() == values.size(), "one value a simplex is needed");
    std::vector<SimplexState> result;
    result.reserve(states.size());
    for (std::size_t i = 0; i < states.size(); ++i) {
      result.push_back(simplexStep(states[i], values[i], options.spread, options.max_iterations));
    }
    return result;
  }
  Image<SurfaceTexel> renderSurface(const Mesh& mesh,
                                    const Camera& camera,
                                    const Pose& camera_from_object,
                                    const SurfaceWindow& window) override {
    return host::renderSurface(mesh, camera, camera_from_object, window);
  }

 private:
  HostSearch& search_;
};

struct HostPath {
  ForegroundOnHost foreground;
  HostScenes scenes;
  HostSearch search;
  HostProbe probe{search};
  RefineOnHost refine{probe, true};
};

}  // namespace

std::unique_ptr<StageSet> makeHostStages() {
  return stageSetOf("host", "", std::make_shared<HostPath>());
}

}  // namespace rangepose
