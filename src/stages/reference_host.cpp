#include "stages/reference_host.h"

#include <algorithm>
#include <cmath>
#include <mutex>

#include "core/parallel.h"
#include "stages/channels_host.h"
#include "stages/surface.h"

namespace rangepose {

Camera tileCamera(const ReferenceObject& object) {
  Camera camera;
  camera.width = object.size;
  camera.height = object.size;
  camera.cx = 0.5 * object.size - 0.5;
  camera.cy = camera.cx;
  camera.orthographic = true;
  camera.pixel_size_mm = object.pixel_mm;
  return camera;
}

Pose tilePose(const ReferenceObject& object, const glm::dmat3& view_from_object) {
  const glm::dvec3 center(0.0, 0.0, object.size * object.pixel_mm);
  return {view_from_object, center - view_from_object * object.center_mm};
}

void describeTile(ReferenceObject& object, int index) {
  ReferenceView& view = object.views[static_cast<std::size_t>(index)];
  const glm::ivec2 origin = object.tileOrigin(index);
  view.box = {object.size, object.size, 0, 0};
  view.area_px = 0.0f;
  view.anchor_px = glm::vec3(0.0f);
  float largest = -1.0f;
  for (int v = 0; v < object.size; ++v) {
    for (int u = 0; u < object.size; ++u) {
      const ReferenceTexel& texel = object.atlas.at(origin.x + u, origin.y + v);
      if (texel.g == 0.0f) continue;
      view.box = {std::min(view.box.x0, u),
                  std::min(view.box.y0, v),
                  std::max(view.box.x1, u + 1),
                  std::max(view.box.y1, v + 1)};
      view.area_px += 1.0f;
      if (texel.r <= largest) continue;
      largest = texel.r;
      view.anchor_px = {static_cast<float>(u), static_cast<float>(v), texel.g};
    }
  }
  if (view.area_px == 0.0f) view.box = {};
}

namespace host {
namespace {

void renderTile(ReferenceObject& object, int index, const ChannelOptions& options) {
  const Camera camera = tileCamera(object);
  const SurfaceWindow window{0, 0, object.size, object.size, 1};
  const Image<SurfaceTexel> surface =
      renderSurface(object.mesh,
                    camera,
                    tilePose(object, object.views[static_cast<std::size_t>(index)].rotation),
                    window);
  Image<float> range(object.size, object.size, 0.0f);
  std::transform(surface.begin(), surface.end(), range.begin(), [&](const SurfaceTexel& texel) {
    return static_cast<float>(static_cast<double>(texel.w) / object.pixel_mm);
  });
  const Image<float> edge = edges(range, options.edgeThresholdPx());
  const Image<float> signed_distance = distance(range, edge, options.edt_passes);
  const glm::ivec2 origin = object.tileOrigin(index);
  for (int v = 0; v < object.size; ++v) {
    for (int u = 0; u < object.size; ++u) {
      object.atlas.at(origin.x + u, origin.y + v) = {
          signed_distance.at(u, v), range.at(u, v), edge.at(u, v), std::abs(surface.at(u, v).z)};
    }
  }
  describeTile(object, index);
}

}  // namespace

void renderReferences(ReferenceObject& object,
                      const ChannelOptions& options,
                      const std::function<void(int, int)>& progress) {
  options.check();
  const int count = static_cast<int>(object.views.size());
  const int columns = atlasColumns(count);
  const int rows = (count + columns - 1) / columns;
  object.edt_passes = options.edt_passes;
  object.serial = newReferenceSerial();
  object.atlas =
      Image<ReferenceTexel>(columns * object.size, rows * object.size, ReferenceTexel(0.0f));
  std::mutex progress_mutex;
  int done = 0;
  constexpr int kViewsPerPiece = 16;
  parallelFor(count, kViewsPerPiece, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) renderTile(object, i, options);
    const std::lock_guard<std::mutex> lock(progress_mutex);
    done += end - begin;
    if (progress) progress(done, count);
  });
}

}  // namespace host
}  // namespace rangepose
