#include "stages/channels_host.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/parallel.h"
#include "stages/channels_core.h"
#include "stages/edt_core.h"
#include "stages/lanes.h"

namespace rangepose {

void ChannelOptions::check() const {
  RP_CHECK(edge_fraction > 0.0f && edge_fraction < 1.0f, "edge_fraction must lie in (0, 1)");
  RP_CHECK(image_width_px >= 8 && image_width_px <= 256, "image_width_px must lie in 8..256");
  RP_CHECK(edt_passes >= 1 && edt_passes <= 255, "edt_passes must lie in 1..255");
}

}  // namespace rangepose

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

/// The fields of EdtTexel as images, of which eight pixels are read at once. Around them lies a
/// frame, one pixel wide, without a site: it stands for everything outside of the image.
struct EdtPlanes {
  EdtPlanes(int width, int height)
      : site_x(width + 2 + kLanes, height + 2, 0.0f),
        site_y(site_x),
        signed_sq(site_x),
        found(site_x) {}
  Image<float> site_x;
  Image<float> site_y;
  Image<float> signed_sq;
  Image<float> found;
};

struct EdtEight {
  Float8 site_x;
  Float8 site_y;
  Float8 signed_sq;
  Float8 found;
};

/// Texels around eight of a row.
struct EdtAround {
  const EdtPlanes& planes;
  int x;
  int y;

  RP_LANES EdtEight operator()(int dx, int dy) const {
    const auto from = [&](const Image<float>& plane) {
      return load8(plane.row(y + 1 + dy) + x + 1 + dx);
    };
    return {from(planes.site_x), from(planes.site_y), from(planes.signed_sq), from(planes.found)};
  }
};

RP_SIMD_CLONES void edtStepOfRow(const EdtPlanes& from, EdtPlanes& into, int y, int width) {
  constexpr Float8 kColumns{0.0f, 1.0f, 2.0f, 3.0f, 4.0f, 5.0f, 6.0f, 7.0f};
  const Float8 row = splat8(static_cast<float>(y));
  int x = 0;
  for (; x < width; x += kLanes) {
    const EdtEight texels =
        edtStepOf<EdtEight>(kColumns + static_cast<float>(x), row, EdtAround{from, x, y});
    store8(into.site_x.row(y + 1) + x + 1, texels.site_x);
    store8(into.site_y.row(y + 1) + x + 1, texels.site_y);
    store8(into.signed_sq.row(y + 1) + x + 1, texels.signed_sq);
    store8(into.found.row(y + 1) + x + 1, texels.found);
  }
  // The last eight may reach into the frame.
  std::fill(into.found.row(y + 1) + width + 1, into.found.row(y + 1) + x + 1, 0.0f);
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
  EdtPlanes current(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const EdtTexel texel = edtInit(x, y, range_px.at(x, y), edges.at(x, y), passes);
      current.site_x.at(x + 1, y + 1) = texel.site_x;
      current.site_y.at(x + 1, y + 1) = texel.site_y;
      current.signed_sq.at(x + 1, y + 1) = texel.signed_sq;
      current.found.at(x + 1, y + 1) = texel.found;
    }
  }
  EdtPlanes next = current;
  for (int pass = 0; pass < passes; ++pass) {
    parallelFor(height, kRowsPerPiece, [&](int begin, int end) {
      for (int y = begin; y < end; ++y) edtStepOfRow(current, next, y, width);
    });
    std::swap(current, next);
  }
  Image<EdtTexel> result(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      result.at(x, y) = {current.site_x.at(x + 1, y + 1),
                         current.site_y.at(x + 1, y + 1),
                         current.signed_sq.at(x + 1, y + 1),
                         current.found.at(x + 1, y + 1)};
    }
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
