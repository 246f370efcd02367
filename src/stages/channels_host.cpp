#include "stages/channels_host.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "stages/channels_core.h"
#include "stages/edt_core.h"

namespace rangepose::host {
namespace {

constexpr int kRowsPerPiece = 32;

/// Calls `pixel(nine)` with the 3x3 pixels around each pixel; outside of the image the border
/// repeats. The columns between the first and the last are a loop of their own, which vectorises.
template <typename Pixel>
Image<float> fromNine(const Image<float>& image, const Pixel& pixel) {
  const int width = image.width();
  const int height = image.height();
  Image<float> result(width, height);
  parallelFor(height, kRowsPerPiece, [&](int begin, int end) {
    for (int y = begin; y < end; ++y) {
      const float* above = image.row(std::max(y - 1, 0));
      const float* here = image.row(y);
      const float* below = image.row(std::min(y + 1, height - 1));
      const auto at = [&](int left, int x, int right) {
        float nine[9] = {above[left],
                         above[x],
                         above[right],
                         here[left],
                         here[x],
                         here[right],
                         below[left],
                         below[x],
                         below[right]};
        return pixel(nine);
      };
      float* out = result.row(y);
      out[0] = at(0, 0, std::min(1, width - 1));
      for (int x = 1; x < width - 1; ++x) out[x] = at(x - 1, x, x + 1);
      if (width > 1) out[width - 1] = at(width - 2, width - 1, width - 1);
    }
  });
  return result;
}

}  // namespace

Image<float> median(const Image<float>& range) {
  return fromNine(range, [](float(&nine)[9]) { return medianOfNine(nine); });
}

Image<float> edges(const Image<float>& range_px, float threshold_px) {
  const Image<float> steps = fromNine(
      range_px, [threshold_px](float(&nine)[9]) { return stepOfNine(nine, threshold_px); });
  return fromNine(steps, [](float(&nine)[9]) { return edgeOfSteps(nine); });
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
