// What the search reads of a scene: range, edges and signed distances of one orthographic image.
#pragma once

#include <cstdint>

#include "core/camera.h"
#include "core/image.h"

namespace rangepose {

/// State of a pixel of the ping-pong distance transform (paper Sect. 5.2, Algorithm 1).
/// Layout of an RGBA32F texel.
struct EdtTexel {
  float site_x = 0.0f;     ///< nearest edge pixel found so far [px]
  float site_y = 0.0f;     ///< [px]
  float signed_sq = 0.0f;  ///< squared distance to it [px^2], negative on background
  float found = 0.0f;      ///< 1 once an edge pixel was found, else 0
  bool operator==(const EdtTexel&) const = default;
};

/// Label of pixels that belong to no patch.
inline constexpr std::int32_t kNoPatch = -1;

struct SceneChannels {
  OrthoCamera camera;
  Image<float> range_px;     ///< distance along z [px of camera.pixel_mm], 0 = background or hole
  Image<float> edges;        ///< 1 on an edge, else 0
  Image<float> distance_px;  ///< signed distance to the nearest edge [px], clamped to passes + 1
};

/// How an orthographic range image is turned into channels (paper Sect. 5.1, 5.2).
/// The same values make the references and the scene comparable.
struct ChannelOptions {
  /// A pixel is an edge where the range jumps by more than this share of the width of a reference
  /// image (the paper's 4 % of the image width).
  float edge_fraction = 0.04f;
  int image_width_px = 64;  ///< width of a reference image [px]
  int edt_passes = 7;       ///< distances are clamped to edt_passes + 1 [px]

  float edgeThresholdPx() const { return edge_fraction * static_cast<float>(image_width_px); }
  void check() const;
};

/// A start of the simplex: the most inner pixel of a patch (paper Sect. 6.1).
struct Seed {
  float x_px = 0.0f;           ///< column in the orthographic scene image [px]
  float y_px = 0.0f;           ///< row [px]
  float range_px = 0.0f;       ///< range there [px]
  float distance_px = 0.0f;    ///< EDT value there: size of the patch [px]
  float mean_range_px = 0.0f;  ///< mean range of its patch [px]
  int patch_px = 0;            ///< pixels in its patch
};

}  // namespace rangepose
