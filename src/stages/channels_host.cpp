#include "stages/channels_host.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "stages/channels_core.h"
#include "stages/edt_core.h"

namespace rangepose::host {
namespace {

constexpr int kRowsPerPiece = 32;

float medianAt(
    const float* above, const float* here, const float* below, int left, int x, int right) {
  float nine[9] = {above[left],
                   above[x],
                   above[right],
                   here[left],
                   here[x],
                   here[right],
                   below[left],
                   below[x],
                   below[right]};
  return medianOfNine(nine);
}

}  // namespace

Image<float> median(const Image<float>& range) {
  const int width = range.width();
  const int height = range.height();
  Image<float> result(width, height);
  parallelFor(height, kRowsPerPiece, [&](int begin, int end) {
    for (int y = begin; y < end; ++y) {
      const float* above = range.row(std::max(y - 1, 0));
      const float* here = range.row(y);
      const float* below = range.row(std::min(y + 1, height - 1));
      float* out = result.row(y);
      out[0] = medianAt(above, here, below, 0, 0, std::min(1, width - 1));
      for (int x = 1; x < width - 1; ++x) out[x] = medianAt(above, here, below, x - 1, x, x + 1);
      if (width > 1) out[width - 1] = medianAt(above, here, below, width - 2, width - 1, width - 1);
    }
  });
  return result;
}

Image<float> edges(const Image<float>& range_px, float threshold_px) {
  const int width = range_px.width();
  const int height = range_px.height();
  Image<float> result(width, height);
  parallelFor(height, kRowsPerPiece, [&](int begin, int end) {
    for (int y = begin; y < end; ++y) {
      const float* above = range_px.row(std::max(y - 1, 0));
      const float* here = range_px.row(y);
      const float* below = range_px.row(std::min(y + 1, height - 1));
      float* out = result.row(y);
      for (int x = 0; x < width; ++x) {
        const int left = std::max(x - 1, 0);
        const int right = std::min(x + 1, width - 1);
        const float nine[9] = {above[left],
                               above[x],
                               above[right],
                               here[left],
                               here[x],
                               here[right],
                               below[left],
                               below[x],
                               below[right]};
        out[x] = edgeOfNine(nine, threshold_px);
      }
    }
  });
  return result;
}

Image<EdtTexel> distanceTexels(const Image<float>& range_px,
                               const Image<float>& edges,
                               int passes) {
  const int width = range_px.width();
  const int height = range_px.height();
  // A frame of texels without a site stands for everything outside of the image.
  Image<EdtTexel> current(width + 2, height + 2);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      current.at(x + 1, y + 1) = edtInit(x, y, range_px.at(x, y), edges.at(x, y), passes);
    }
  }
  Image<EdtTexel> next = current;
  for (int pass = 0; pass < passes; ++pass) {
    parallelFor(height, kRowsPerPiece, [&](int begin, int end) {
      for (int y = begin; y < end; ++y) {
        for (int x = 0; x < width; ++x) {
          next.at(x + 1, y + 1) =
              edtStep(x, y, [&](int nx, int ny) { return current.at(nx + 1, ny + 1); });
        }
      }
    });
    std::swap(current, next);
  }
  Image<EdtTexel> result(width, height);
  for (int y = 0; y < height; ++y) {
    std::copy_n(current.row(y + 1) + 1, static_cast<std::size_t>(width), result.row(y));
  }
  return result;
}

Image<float> distance(const Image<float>& range_px, const Image<float>& edges, int passes) {
  const Image<EdtTexel> texels = distanceTexels(range_px, edges, passes);
  Image<float> result(range_px.width(), range_px.height());
  std::transform(texels.begin(), texels.end(), result.begin(), edtRoot);
  return result;
}

SceneChannels channels(const OrthoCamera& camera,
                       const Image<float>& range_px,
                       const ChannelOptions& options) {
  SceneChannels result;
  result.camera = camera;
  result.range_px = median(range_px);
  result.edges = edges(result.range_px, options.edgeThresholdPx());
  result.distance_px = distance(result.range_px, result.edges, options.edt_passes);
  return result;
}

}  // namespace rangepose::host
