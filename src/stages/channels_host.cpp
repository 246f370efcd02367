#include "stages/channels_host.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/parallel.h"
#include "stages/edt_core.h"

namespace rangepose::host {
namespace {

constexpr int kRowsPerPiece = 32;

void order(float& low, float& high) {
  const float smaller = std::min(low, high);
  high = std::max(low, high);
  low = smaller;
}

/// Median of nine by a sorting network without branches, so that the row loop vectorises
/// (Paeth 1990, "Median finding on a 3x3 grid").
float medianOfNine(std::array<float, 9> p) {
  order(p[1], p[2]);
  order(p[4], p[5]);
  order(p[7], p[8]);
  order(p[0], p[1]);
  order(p[3], p[4]);
  order(p[6], p[7]);
  order(p[1], p[2]);
  order(p[4], p[5]);
  order(p[7], p[8]);
  p[3] = std::max(p[0], p[3]);
  p[5] = std::min(p[5], p[8]);
  order(p[4], p[7]);
  p[6] = std::max(p[3], p[6]);
  p[4] = std::max(p[1], p[4]);
  p[2] = std::min(p[2], p[5]);
  p[4] = std::min(p[4], p[7]);
  order(p[4], p[2]);
  p[4] = std::max(p[6], p[4]);
  return std::min(p[4], p[2]);
}

float medianAt(
    const float* above, const float* here, const float* below, int left, int x, int right) {
  return medianOfNine({above[left],
                       above[x],
                       above[right],
                       here[left],
                       here[x],
                       here[right],
                       below[left],
                       below[x],
                       below[right]});
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
      const std::array<const float*, 3> rows = {range_px.row(std::max(y - 1, 0)),
                                                range_px.row(y),
                                                range_px.row(std::min(y + 1, height - 1))};
      float* out = result.row(y);
      for (int x = 0; x < width; ++x) {
        const float here = rows[1][x];
        float jump = 0.0f;
        for (const float* row : rows) {
          for (const int neighbour : {std::max(x - 1, 0), x, std::min(x + 1, width - 1)}) {
            jump = std::max(jump, std::abs(row[neighbour] - here));
          }
        }
        out[x] = here != 0.0f && jump > threshold_px ? 1.0f : 0.0f;
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
  std::transform(texels.begin(), texels.end(), result.begin(), [](const EdtTexel& texel) {
    const float root = std::sqrt(std::abs(texel.signed_sq));
    return texel.signed_sq < 0.0f ? -root : root;
  });
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
