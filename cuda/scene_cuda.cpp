#include "cuda/scene_cuda.h"

#include <algorithm>
#include <string>
#include <utility>

#include "core/error.h"
#include "stages/resample_host.h"

namespace rangepose::cuda {
namespace {

std::vector<float> foregroundOf(const DepthImage& image, const Image<std::uint8_t>& keep) {
  std::vector<float> kept(image.depth_mm.begin(), image.depth_mm.end());
  if (keep.empty()) return kept;
  std::transform(
      keep.begin(), keep.end(), kept.begin(), kept.begin(), [](std::uint8_t keeps, float mm) {
        return keeps != 0 ? mm : 0.0f;
      });
  return kept;
}

/// Copies take their size from the camera.
template <typename AnyCamera>
void requireSize(const Image<float>& image, const AnyCamera& camera, const std::string& what) {
  RP_CHECK(image.width() == camera.width && image.height() == camera.height,
           what + ": another size than its camera's");
}

std::size_t pixelsOf(const DeviceImage& image) {
  return static_cast<std::size_t>(image.width()) * static_cast<std::size_t>(image.height());
}

Image<std::int32_t> labelled(Workspace& workspace,
                             const DeviceImage& range,
                             const DeviceImage& edge,
                             const Frame& frame,
                             cudaStream_t stream) {
  workspace.labels.reserve(pixelsOf(range));
  patches(frame.view(range), frame.view(edge), workspace.labels.data(), stream);
  Image<std::int32_t> labels(range.width(), range.height());
  const Landing landing(stream);
  workspace.labels.download(labels.data(), labels.size(), stream);
  workspace.synchronize();
  return labels;
}

Image<float> fetched(Workspace& workspace, const Frame& frame, const DeviceImage& image) {
  Image<float> result(image.width(), image.height());
  const Landing landing(workspace.begin());
  frame.download(image, result.data());
  workspace.synchronize();
  return result;
}

void resampleInto(Workspace& workspace,
                  const CudaDepth& depth,
                  const OrthoCamera& camera,
                  const PixelBox& region,
                  ImageView into,
                  cudaStream_t stream) {
  const PixelBox all{0, 0, depth.camera().width, depth.camera().height};
  workspace.splats.reserve(static_cast<std::size_t>(into.width) *
                           static_cast<std::size_t>(into.height));
  resample(depth.pixels(),
           resampleSetup(depth.camera(), camera),
           region.empty() ? all : region,
           workspace.splats.data(),
           into,
           stream);
}

}  // namespace

Workspace::Workspace(gles::Context* context, DeviceImage::Memory memory)
    : context_(context),
      memory_(memory),
      images_(memory),
      depths_(std::make_shared<std::vector<std::unique_ptr<DepthBuffers>>>()) {
  RP_CHECK(context != nullptr || memory == DeviceImage::Memory::kOwn,
           "shared textures need a GL context");
}

Workspace::~Workspace() {
  // The images that go now, also those that scenes still hold, may be textures.
  if (context_ != nullptr) context_->makeCurrentIfPossible();
}

std::shared_ptr<DepthBuffers> Workspace::takeDepth(std::size_t pixels) {
  auto taken = std::make_unique<DepthBuffers>();
  if (!depths_->empty()) {
    taken = std::move(depths_->back());
    depths_->pop_back();
  }
  taken->depth.reserve(pixels);
  taken->foreground.reserve(pixels);
  taken->keep.reserve(pixels);
  const std::weak_ptr free = depths_;
  return {taken.release(), [free](DepthBuffers* returned) {
            std::unique_ptr<DepthBuffers> owned(returned);
            if (const auto all = free.lock()) all->push_back(std::move(owned));
          }};
}

cudaStream_t Workspace::begin() {
  if (context_ != nullptr) context_->makeCurrent();
  return stream_.get();
}

CudaScene::CudaScene(Workspace& workspace, const OrthoCamera& camera)
    : workspace_(workspace),
      camera_(camera),
      range_(workspace.take(Element::kFloat, camera.width, camera.height)),
      edges_(workspace.take(Element::kFloat, camera.width, camera.height)),
      distance_(workspace.take(Element::kFloat, camera.width, camera.height)) {}

SceneChannels CudaScene::download() const {
  const Frame frame({range_.get(), edges_.get(), distance_.get()}, workspace_.begin());
  SceneChannels channels;
  channels.camera = camera_;
  for (Image<float>* image : {&channels.range_px, &channels.edges, &channels.distance_px}) {
    *image = Image<float>(camera_.width, camera_.height);
  }
  const Landing landing(workspace_.begin());
  frame.download(*range_, channels.range_px.data());
  frame.download(*edges_, channels.edges.data());
  frame.download(*distance_, channels.distance_px.data());
  workspace_.synchronize();
  return channels;
}

CudaDepth::CudaDepth(const DepthImage& image, const Image<std::uint8_t>& keep, Workspace& workspace)
    : camera_(image.camera),
      masked_(!keep.empty()),
      buffers_(workspace.takeDepth(image.depth_mm.size())) {
  requireSize(image.depth_mm, camera_, "depth image");
  RP_CHECK(keep.empty() || keep.size() == image.depth_mm.size(),
           "the mask has another size than the depth image");
  const cudaStream_t stream = workspace.begin();
  buffers_->depth.upload(image.depth_mm.data(), image.depth_mm.size(), stream);
  const std::vector<float> kept = foregroundOf(image, keep);
  buffers_->foreground.upload(kept.data(), kept.size(), stream);
  if (masked_) buffers_->keep.upload(keep.data(), keep.size(), stream);
}

DepthPixels CudaDepth::pixels() const {
  return {buffers_->depth.data(),
          masked_ ? buffers_->keep.data() : nullptr,
          camera_.width,
          camera_.height};
}

std::unique_ptr<CudaScene> prepareScene(Workspace& workspace,
                                        const CudaDepth& depth,
                                        const OrthoCamera& camera,
                                        const PixelBox& region,
                                        const ChannelOptions& options) {
  options.check();
  const cudaStream_t stream = workspace.begin();
  auto scene = std::make_unique<CudaScene>(workspace, camera);
  const auto raw = workspace.take(Element::kFloat, camera.width, camera.height);
  const auto even = workspace.take(Element::kFloat4, camera.width, camera.height);
  const auto odd = workspace.take(Element::kFloat4, camera.width, camera.height);
  const Frame frame(
      {&scene->range(), &scene->edges(), &scene->distance(), raw.get(), even.get(), odd.get()},
      stream);
  const ImageView range = frame.view(scene->range());
  const ImageView edge = frame.view(scene->edges());
  resampleInto(workspace, depth, camera, region, frame.view(*raw), stream);
  median(frame.view(*raw), range, stream);
  edges(range, options.edgeThresholdPx(), edge, stream);
  distance(range,
           edge,
           options.edt_passes,
           {frame.view(*even), frame.view(*odd)},
           frame.view(scene->distance()),
           stream);
  return scene;
}

std::unique_ptr<CudaScene> uploadScene(Workspace& workspace, const SceneChannels& channels) {
  requireSize(channels.range_px, channels.camera, "range image");
  requireSize(channels.edges, channels.camera, "edge image");
  requireSize(channels.distance_px, channels.camera, "distance image");
  const cudaStream_t stream = workspace.begin();
  auto scene = std::make_unique<CudaScene>(workspace, channels.camera);
  const Frame frame({&scene->range(), &scene->edges(), &scene->distance()}, stream);
  frame.upload(scene->range(), channels.range_px.data());
  frame.upload(scene->edges(), channels.edges.data());
  frame.upload(scene->distance(), channels.distance_px.data());
  return scene;
}

Image<std::int32_t> patchesOf(Workspace& workspace, const CudaScene& scene) {
  const cudaStream_t stream = workspace.begin();
  const Frame frame({&scene.range(), &scene.edges()}, stream);
  return labelled(workspace, scene.range(), scene.edges(), frame, stream);
}

Image<float> resampled(Workspace& workspace, const CudaDepth& depth, const OrthoCamera& camera) {
  const cudaStream_t stream = workspace.begin();
  const auto range = workspace.take(Element::kFloat, camera.width, camera.height);
  const Frame frame({range.get()}, stream);
  resampleInto(workspace, depth, camera, {}, frame.view(*range), stream);
  return fetched(workspace, frame, *range);
}

Image<float> medianOf(Workspace& workspace, const Image<float>& range) {
  const cudaStream_t stream = workspace.begin();
  const auto from = workspace.take(range);
  const auto to = workspace.take(range);
  const Frame frame({from.get(), to.get()}, stream);
  frame.upload(*from, range.data());
  median(frame.view(*from), frame.view(*to), stream);
  return fetched(workspace, frame, *to);
}

Image<float> edgesOf(Workspace& workspace, const Image<float>& range_px, float threshold_px) {
  const cudaStream_t stream = workspace.begin();
  const auto from = workspace.take(range_px);
  const auto to = workspace.take(range_px);
  const Frame frame({from.get(), to.get()}, stream);
  frame.upload(*from, range_px.data());
  edges(frame.view(*from), threshold_px, frame.view(*to), stream);
  return fetched(workspace, frame, *to);
}

namespace {

/// The images of a distance transform with range and edges uploaded.
struct DistanceImages {
  DistanceImages(Workspace& workspace, const Image<float>& range_px, const Image<float>& edge)
      : stream(workspace.begin()),
        range(workspace.take(range_px)),
        edges(workspace.take(range_px)),
        result(workspace.take(range_px)),
        even(workspace.take(Element::kFloat4, range_px.width(), range_px.height())),
        odd(workspace.take(Element::kFloat4, range_px.width(), range_px.height())),
        frame({range.get(), edges.get(), result.get(), even.get(), odd.get()}, stream) {
    RP_CHECK(edge.width() == range_px.width() && edge.height() == range_px.height(),
             "range and edges differ in size");
    frame.upload(*range, range_px.data());
    frame.upload(*edges, edge.data());
  }
  EdtScratch scratch() const { return {frame.view(*even), frame.view(*odd)}; }

  cudaStream_t stream;
  ImagePool::Lease range;
  ImagePool::Lease edges;
  ImagePool::Lease result;
  ImagePool::Lease even;
  ImagePool::Lease odd;
  Frame frame;
};

}  // namespace

Image<EdtTexel> distanceTexelsOf(Workspace& workspace,
                                 const Image<float>& range_px,
                                 const Image<float>& edges,
                                 int passes) {
  const DistanceImages images(workspace, range_px, edges);
  const Frame& frame = images.frame;
  const ImageView last = distanceTexels(frame.view(*images.range),
                                        frame.view(*images.edges),
                                        passes,
                                        images.scratch(),
                                        images.stream);
  const bool in_even = last.texture == frame.view(*images.even).texture;
  Image<EdtTexel> texels(range_px.width(), range_px.height());
  const Landing landing(images.stream);
  frame.download(in_even ? *images.even : *images.odd, texels.data());
  workspace.synchronize();
  return texels;
}

Image<float> distanceOf(Workspace& workspace,
                        const Image<float>& range_px,
                        const Image<float>& edges,
                        int passes) {
  const DistanceImages images(workspace, range_px, edges);
  const Frame& frame = images.frame;
  distance(frame.view(*images.range),
           frame.view(*images.edges),
           passes,
           images.scratch(),
           frame.view(*images.result),
           images.stream);
  return fetched(workspace, frame, *images.result);
}

Image<std::int32_t> patchesOf(Workspace& workspace,
                              const Image<float>& range_px,
                              const Image<float>& edges) {
  const DistanceImages images(workspace, range_px, edges);
  return labelled(workspace, *images.range, *images.edges, images.frame, images.stream);
}

}  // namespace rangepose::cuda
