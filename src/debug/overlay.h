// Posed models drawn over the depth image that they were found in, with what speaks for and against
// them.
#pragma once

#include <filesystem>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "core/camera.h"
#include "core/pose.h"
#include "geometry/mesh.h"

namespace rangepose::debug {

struct OverlayPose {
  const Mesh* mesh = nullptr;  ///< must outlive the call
  Pose camera_from_object;
  double score = 0.0;
  std::string label;  ///< ASCII, e.g. "1 elbow"
};

struct OverlayOptions {
  /// Depths that differ by at most this much agree [mm]; 0 takes kToleranceShare of the smallest
  /// diameter.
  double tolerance_mm = 0.0;
  int max_zooms = 6;  ///< poses, from the first, that get an enlarged view of their own
};

inline constexpr double kToleranceShare = 0.025;  ///< of a model's diameter

/// What the depth image says about the part of a model that would be seen, in depth pixels.
struct Agreement {
  int model_px = 0;     ///< pixels that the model covers
  int agrees_px = 0;    ///< scene within the tolerance
  int in_front_px = 0;  ///< the sensor looked through the model: contradiction
  int hidden_px = 0;    ///< something lies before the model: says nothing
  int missing_px = 0;   ///< no measurement
};

/// Where a drawn view lies in the picture.
struct OverlayPanel {
  cv::Rect box;        ///< in the picture [px]
  PixelBox source;     ///< the part of the depth image that it shows [px]
  double scale = 1.0;  ///< picture pixels a depth pixel
};

struct OverlayPicture {
  cv::Mat image;         ///< 8-bit BGR, at least 1200 px wide
  OverlayPanel relief;   ///< the bare depth image
  OverlayPanel overlay;  ///< the same view with the models
  std::vector<OverlayPanel>
      zooms;  ///< overlay side of the enlarged view of each pose; box empty if not seen
  std::vector<Agreement> agreement;  ///< one a pose
  double tolerance_mm = 0.0;         ///< the one used
};

/// Colour of a pixel that the model covers (blue, green, red), before it is laid over the relief;
/// difference = scene depth - model depth. Green up to the tolerance, orange to red where the model
/// stands in front of the data, cyan to blue where it is hidden behind the data.
cv::Vec3b differenceColour(double difference_mm, double tolerance_mm);

/// Counted at the depth image's own pixels.
Agreement agreementOf(const DepthImage& image, const OverlayPose& pose, double tolerance_mm);

/// Left the bare relief, right the models over it, below both enlarged around each pose, then the
/// legend.
OverlayPicture drawOverlay(const DepthImage& image,
                           const std::vector<OverlayPose>& poses,
                           const OverlayOptions& options = {});

/// drawOverlay into a PNG file, written whole or not at all.
void writeOverlay(const std::filesystem::path& file,
                  const DepthImage& image,
                  const std::vector<OverlayPose>& poses,
                  const OverlayOptions& options = {});

}  // namespace rangepose::debug
