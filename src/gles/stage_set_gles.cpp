#include "gles/stage_set_gles.h"

#include <cstdint>
#include <unordered_map>
#include <utility>

#include "core/error.h"
#include "gles/channels_gles.h"
#include "gles/search_gles.h"
#include "gles/surface_gles.h"

namespace rangepose::gles {
namespace {

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

const GlesScene& glesScene(const ResidentScene& scene) {
  const auto* own = dynamic_cast<const GlesScene*>(&scene);
  RP_CHECK(own != nullptr, "the scene was prepared by another path than glsl");
  return *own;
}

class GlesStages : public StageSet {
 public:
  GlesStages(Context& context, const Defines& extra)
      : context_((context.makeCurrent(), context)), device_(context, extra) {}
  GlesStages(const GlesStages&) = delete;
  GlesStages& operator=(const GlesStages&) = delete;
  ~GlesStages() override { context_.makeCurrentIfPossible(); }

  std::string name() const override { return "glsl"; }
  DeviceWork work() const override { return {device_.draws(), 0}; }

  Image<float> resample(const DepthImage& image,
                        const Image<std::uint8_t>& keep,
                        const OrthoCamera& camera) override {
    return gles::resample(current(), image, keep, camera, {}).texture.downloadFloats();
  }
  Image<float> median(const Image<float>& range) override {
    return gles::median(current(), Texture(range)).texture.downloadFloats();
  }
  Image<float> edges(const Image<float>& range_px, float threshold_px) override {
    return gles::edges(current(), Texture(range_px), threshold_px).texture.downloadFloats();
  }
  Image<EdtTexel> distanceTexels(const Image<float>& range_px,
                                 const Image<float>& edges,
                                 int passes) override {
    Device& device = current();
    return downloadEdt(
        gles::distanceTexels(device, Texture(range_px), Texture(edges), passes).texture);
  }
  Image<float> distance(const Image<float>& range_px,
                        const Image<float>& edges,
                        int passes) override {
    Device& device = current();
    return gles::distance(device, Texture(range_px), Texture(edges), passes)
        .texture.downloadFloats();
  }
  Image<std::int32_t> patches(const Image<float>& range_px, const Image<float>& edges) override {
    Device& device = current();
    return gles::patches(device, Texture(range_px), Texture(edges)).texture.downloadInts();
  }
  std::vector<ErrorTerms> errorTerms(const ReferenceObject& object,
                                     const SceneChannels& window,
                                     const std::vector<glm::vec3>& translations_px,
                                     const ErrorOptions& options) override;
  std::vector<SimplexState> simplexSteps(const std::vector<SimplexState>& states,
                                         const std::vector<float>& values,
                                         const SimplexOptions& options) override {
    options.check();
    return gles::simplexSteps(current(), states, values, options);
  }
  Image<SurfaceTexel> renderSurface(const Mesh& mesh,
                                    const Camera& camera,
                                    const Pose& camera_from_object,
                                    const SurfaceWindow& window) override;

  using StageSet::prepare;
  std::unique_ptr<ResidentScene> prepare(const DepthImage& image,
                                         const Image<std::uint8_t>& keep,
                                         const OrthoCamera& camera,
                                         const PixelBox& region,
                                         const ChannelOptions& options) override;
  std::unique_ptr<ResidentScene> upload(const SceneChannels& channels) override;
  Image<std::int32_t> patches(const ResidentScene& scene) override {
    const GlesScene& own = glesScene(scene);
    return gles::patches(current(), own.range_px, own.edges).texture.downloadInts();
  }
  std::vector<Hypothesis> search(const ReferenceObject& object,
                                 const std::vector<const ResidentScene*>& windows,
                                 const std::vector<float>& seed_range_px,
                                 const SearchOptions& options) override;

 private:
  /// The device, with the context current on this thread.
  Device& current() {
    context_.makeCurrent();
    return device_;
  }
  const ResidentObject& resident(const ReferenceObject& object);

  Context& context_;
  Device device_;
  std::unordered_map<const ReferenceObject*, ResidentObject> objects_;
  ResidentMeshes meshes_;
};

const ResidentObject& GlesStages::resident(const ReferenceObject& object) {
  const auto found = objects_.find(&object);
  if (found != objects_.end()) {
    // An object that was rendered or read again has another atlas.
    if (found->second.isOf(object)) return found->second;
    objects_.erase(found);
  }
  return objects_.emplace(&object, ResidentObject(object)).first->second;
}

std::vector<ErrorTerms> GlesStages::errorTerms(const ReferenceObject& object,
                                               const SceneChannels& window,
                                               const std::vector<glm::vec3>& translations_px,
                                               const ErrorOptions& options) {
  options.check();
  Device& device = current();
  const Texture range(window.range_px);
  const Texture distance_px(window.distance_px);
  return gles::errorTerms(device, resident(object), {range, distance_px}, translations_px, options);
}

Image<SurfaceTexel> GlesStages::renderSurface(const Mesh& mesh,
                                              const Camera& camera,
                                              const Pose& camera_from_object,
                                              const SurfaceWindow& window) {
  if (window.width <= 0 || window.height <= 0) return {};
  Device& device = current();
  return downloadVectors(
      gles::renderSurface(device, mesh, meshes_.of(mesh), camera, camera_from_object, window)
          .texture);
}

std::unique_ptr<ResidentScene> GlesStages::prepare(const DepthImage& image,
                                                   const Image<std::uint8_t>& keep,
                                                   const OrthoCamera& camera,
                                                   const PixelBox& region,
                                                   const ChannelOptions& options) {
  options.check();
  Device& device = current();
  const Canvas raw = gles::resample(device, image, keep, camera, region);
  Canvas range = gles::median(device, raw.texture);
  Canvas edge = gles::edges(device, range.texture, options.edgeThresholdPx());
  Canvas distance_px = gles::distance(device, range.texture, edge.texture, options.edt_passes);
  return std::make_unique<GlesScene>(context_,
                                     camera,
                                     std::move(range.texture),
                                     std::move(edge.texture),
                                     std::move(distance_px.texture));
}

std::unique_ptr<ResidentScene> GlesStages::upload(const SceneChannels& channels) {
  context_.makeCurrent();
  return std::make_unique<GlesScene>(context_,
                                     channels.camera,
                                     Texture(channels.range_px),
                                     Texture(channels.edges),
                                     Texture(channels.distance_px));
}

std::vector<Hypothesis> GlesStages::search(const ReferenceObject& object,
                                           const std::vector<const ResidentScene*>& windows,
                                           const std::vector<float>& seed_range_px,
                                           const SearchOptions& options) {
  options.simplex.check();
  options.error.check();
  RP_CHECK(windows.size() == seed_range_px.size(), "one seed range a window is needed");
  Device& device = current();
  const float max_area = object.maxArea();
  std::vector<float> areas;
  for (const ReferenceView& view : object.views) {
    areas.push_back(areaFactor(options.error.area, view.area_px, max_area));
  }
  std::vector<Hypothesis> all;
  for (std::size_t w = 0; w < windows.size(); ++w) {
    const GlesScene& window = glesScene(*windows[w]);
    std::vector<glm::vec3> starts;
    for (std::size_t i = 0; i < object.views.size(); ++i) {
      starts.push_back(startTranslation(object, static_cast<int>(i), seed_range_px[w]));
    }
    const std::vector<Hypothesis> found = gles::search(
        device, resident(object), {window.range_px, window.distance_px}, starts, areas, options);
    for (Hypothesis hypothesis : found) {
      hypothesis.window = static_cast<int>(w);
      all.push_back(hypothesis);
    }
  }
  return all;
}

}  // namespace

std::unique_ptr<StageSet> makeGlesStages(Context& context, const Defines& extra) {
  return std::make_unique<GlesStages>(context, extra);
}

}  // namespace rangepose::gles
