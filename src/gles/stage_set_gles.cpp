#include "gles/stage_set_gles.h"

#include <cstdint>
#include <utility>

#include "core/kept.h"
#include "gles/channels_gles.h"
#include "gles/search_gles.h"
#include "gles/surface_gles.h"
#include "stages/refine_host.h"

namespace rangepose::gles {
namespace {

/// What all stages of the path share.
struct Shared {
  Shared(Context& its_context, const Defines& extra)
      : context((its_context.makeCurrent(), its_context)), device(its_context, extra) {}

  /// The device, with the context current on this thread.
  Device& current() {
    context.makeCurrent();
    return device;
  }
  std::shared_ptr<const ResidentObject> resident(const ReferenceObject& object) {
    return objects.of(object.serial, [&] { return ResidentObject(object); });
  }

  Context& context;
  Device device;
  Kept<std::uint64_t, ResidentObject> objects{kObjectsKept};
  ResidentMeshes meshes;
};

/// Also as a texture without background, once for all windows.
class GlesDepth : public HostDepth {
 public:
  GlesDepth(Context& context, const DepthImage& image, const Image<std::uint8_t>& kept)
      : HostDepth(image, kept), context_(context), foreground_(foreground_mm) {}
  GlesDepth(const GlesDepth&) = delete;
  GlesDepth& operator=(const GlesDepth&) = delete;
  ~GlesDepth() override { context_.makeCurrentIfPossible(); }

  MeasuredTexture pixels() const { return {depth.camera, foreground_, farthest(foreground_mm)}; }

 private:
  Context& context_;
  const Texture foreground_;
};

class GlesScene : public ResidentScene {
 public:
  GlesScene(
      Context& context, const OrthoCamera& camera, Texture range, Texture edge, Texture distance)
      : context_(context),
        camera_(camera),
        range_px(std::move(range)),
        edges(std::move(edge)),
        distance_px(std::move(distance)) {}
  GlesScene(const GlesScene&) = delete;
  GlesScene& operator=(const GlesScene&) = delete;
  ~GlesScene() override { context_.makeCurrentIfPossible(); }

  const OrthoCamera& camera() const override { return camera_; }
  SceneChannels download() const override {
    context_.makeCurrent();
    return {
        camera_, range_px.downloadFloats(), edges.downloadFloats(), distance_px.downloadFloats()};
  }

 private:
  Context& context_;
  OrthoCamera camera_;

 public:
  const Texture range_px;
  const Texture edges;
  const Texture distance_px;
};

class GlesForeground : public ForegroundOnHost {
 public:
  explicit GlesForeground(Shared& shared) : shared_(shared) {}
  std::unique_ptr<ResidentDepth> upload(const DepthImage& depth,
                                        const Image<std::uint8_t>& keep) override {
    shared_.current();
    return std::make_unique<GlesDepth>(shared_.context, depth, keep);
  }

 private:
  Shared& shared_;
};

class GlesScenes : public SceneStage {
 public:
  explicit GlesScenes(Shared& shared) : shared_(shared) {}
  ResidentScenes prepare(const ResidentDepth& depth,
                         const std::vector<WindowTask>& windows,
                         const ChannelOptions& options) override {
    options.check();
    const MeasuredTexture pixels = ownImage<GlesDepth>(depth).pixels();
    Device& device = shared_.current();
    ResidentScenes scenes;
    for (const auto& [camera, region] : windows) {
      const Canvas raw = gles::resample(device, pixels, camera, region);
      Canvas range = gles::median(device, raw.texture);
      Canvas edge = gles::edges(device, range.texture, options.edgeThresholdPx());
      Canvas distance_px = gles::distance(device, range.texture, edge.texture, options.edt_passes);
      scenes.push_back(std::make_unique<GlesScene>(shared_.context,
                                                   camera,
                                                   std::move(range.texture),
                                                   std::move(edge.texture),
                                                   std::move(distance_px.texture)));
    }
    return scenes;
  }
  std::unique_ptr<ResidentScene> upload(const SceneChannels& channels) override {
    shared_.current();
    return std::make_unique<GlesScene>(shared_.context,
                                       channels.camera,
                                       Texture(channels.range_px),
                                       Texture(channels.edges),
                                       Texture(channels.distance_px));
  }
  Image<std::int32_t> patches(const ResidentScene& scene) override {
    const auto& own = ownImage<GlesScene>(scene);
    return gles::patches(shared_.current(), own.range_px, own.edges).texture.downloadInts();
  }

 private:
  Shared& shared_;
};

class GlesSearch : public SearchStage {
 public:
  explicit GlesSearch(Shared& shared) : shared_(shared) {}
  std::vector<Hypothesis> search(const ReferenceObject& object,
                                 const std::vector<const ResidentScene*>& windows,
                                 const std::vector<float>& seed_range_px,
                                 const SearchOptions& options) override;

 private:
  Shared& shared_;
};

class GlesProbe : public StageProbe {
 public:
  explicit GlesProbe(Shared& shared) : shared_(shared) {}

  Image<float> resample(const DepthImage& image,
                        const Image<std::uint8_t>& keep,
                        const OrthoCamera& camera) override {
    Device& device = shared_.current();
    const GlesDepth depth(shared_.context, image, keep);
    return gles::resample(device, depth.pixels(), camera, {}).texture.downloadFloats();
  }
  Image<float> median(const Image<float>& range) override {
    return gles::median(shared_.current(), Texture(range)).texture.downloadFloats();
  }
  Image<float> edges(const Image<float>& range_px, float threshold_px) override {
    Device& device = shared_.current();
    return gles::edges(device, Texture(range_px), threshold_px).texture.downloadFloats();
  }
  Image<EdtTexel> distanceTexels(const Image<float>& range_px,
                                 const Image<float>& edges,
                                 int passes) override {
    Device& device = shared_.current();
    return downloadEdt(
        gles::distanceTexels(device, Texture(range_px), Texture(edges), passes).texture);
  }
  Image<float> distance(const Image<float>& range_px,
                        const Image<float>& edges,
                        int passes) override {
    Device& device = shared_.current();
    return gles::distance(device, Texture(range_px), Texture(edges), passes)
        .texture.downloadFloats();
  }
  Image<std::int32_t> patches(const Image<float>& range_px, const Image<float>& edges) override {
    Device& device = shared_.current();
    return gles::patches(device, Texture(range_px), Texture(edges)).texture.downloadInts();
  }
  std::vector<ErrorTerms> errorTerms(const ReferenceObject& object,
                                     const SceneChannels& window,
                                     const std::vector<glm::vec3>& translations_px,
                                     const ErrorOptions& options) override {
    options.check();
    Device& device = shared_.current();
    const Texture range(window.range_px);
    const Texture distance_px(window.distance_px);
    return gles::errorTerms(
        device, *shared_.resident(object), {range, distance_px}, translations_px, options);
  }
  std::vector<SimplexState> simplexSteps(const std::vector<SimplexState>& states,
                                         const std::vector<float>& values,
                                         const SimplexOptions& options) override {
    options.check();
    return gles::simplexSteps(shared_.current(), states, values, options);
  }
  Image<SurfaceTexel> renderSurface(const Mesh& mesh,
                                    const Camera& camera,
                                    const Pose& camera_from_object,
                                    const SurfaceWindow& window) override {
    if (window.width <= 0 || window.height <= 0) return {};
    Device& device = shared_.current();
    const std::shared_ptr<const MeshBuffers> buffers = shared_.meshes.of(mesh);
    return downloadVectors(
        gles::renderSurface(device, mesh, *buffers, camera, camera_from_object, window).texture);
  }

 private:
  Shared& shared_;
};

std::vector<Hypothesis> GlesSearch::search(const ReferenceObject& object,
                                           const std::vector<const ResidentScene*>& windows,
                                           const std::vector<float>& seed_range_px,
                                           const SearchOptions& options) {
  options.simplex.check();
  options.error.check();
  RP_CHECK(windows.size() == seed_range_px.size(), "one seed range a window is needed");
  Device& device = shared_.current();
  const std::shared_ptr<const ResidentObject> resident = shared_.resident(object);
  const float max_area = object.maxArea();
  std::vector<float> areas;
  for (const ReferenceView& view : object.views) {
    areas.push_back(areaFactor(options.error.area, view.area_px, max_area));
  }
  std::vector<Hypothesis> all;
  for (std::size_t w = 0; w < windows.size(); ++w) {
    const auto& window = ownImage<GlesScene>(*windows[w]);
    std::vector<glm::vec3> starts;
    for (std::size_t i = 0; i < object.views.size(); ++i) {
      starts.push_back(startTranslation(object, static_cast<int>(i), seed_range_px[w]));
    }
    const std::vector<Hypothesis> found = gles::search(
        device, *resident, {window.range_px, window.distance_px}, starts, areas, options);
    for (Hypothesis hypothesis : found) {
      hypothesis.window = static_cast<int>(w);
      all.push_back(hypothesis);
    }
  }
  return all;
}

struct GlesPath {
  GlesPath(Context& context, const Defines& extra) : shared(context, extra) {}
  GlesPath(const GlesPath&) = delete;
  GlesPath& operator=(const GlesPath&) = delete;
  ~GlesPath() { shared.context.makeCurrentIfPossible(); }

  Shared shared;
  GlesForeground foreground{shared};
  GlesScenes scenes{shared};
  GlesSearch search{shared};
  GlesProbe probe{shared};
  RefineOnHost refine{probe, false};
};

}  // namespace

std::unique_ptr<StageSet> makeGlesStages(Context& context, const Defines& extra) {
  const auto path = std::make_shared<GlesPath>(context, extra);
  std::unique_ptr<StageSet> set = stageSetOf("glsl", kLeftToHost, path);
  set->work = [path] { return DeviceWork{path->shared.device.draws(), 0}; };
  return set;
}

}  // namespace rangepose::gles
