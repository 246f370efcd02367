// What an infrared camera sees of a scene that a projector covers with a pattern of dots.
#pragma once

#include <cstdint>
#include <vector>

#include "sim/clean_view.h"
#include "sim/sensor_model.h"

namespace rangepose {

/// How a surface reflects infrared light: diffuse, and a gloss by Blinn's formula.
struct Reflectance {
  double diffuse = 0.5;    ///< 0..1
  double gloss = 0.0;      ///< of light that is mirrored, 0..1
  double exponent = 20.0;  ///< the higher, the narrower a highlight
};

/// One for each part of a heap, then one for what they lie in; drawn once for a depth image, so
/// that both of its infrared images agree.
std::vector<Reflectance> drawReflectances(std::size_t parts, std::uint64_t seed);

/// The dots of a device, always the same: brightness over the projector's image plane.
class DotPattern {
 public:
  /// `camera` sees the scene; the pattern reaches beyond its image, so that all that is seen from
  /// beside the projector has dots.
  DotPattern(const Camera& camera, const MatchingSensor& sensor);

  /// At a pixel of a camera in the projector's place; bilinear.
  double at(double u, double v) const;

 private:
  int margin_px_ = 0;
  Image<float> texels_;
};

/// A pinhole image plane at another place than the depth camera, with its own view of the scene.
struct Viewpoint {
  CleanView view;               ///< without margin
  glm::dvec3 position_mm{0.0};  ///< in the depth camera's frame, which has the same orientation
};

/// What lights the scene.
struct Illumination {
  const ProjectorView* projector = nullptr;  ///< with its shadows
  const DotPattern* dots = nullptr;
  double ambient = 0.0;  ///< of a dot's middle
};

/// Brightness at each pixel, blurred by the lens; not exposed yet. Light falls off with the square
/// of the way from the projector; `reflectances` as of drawReflectances().
Image<float> infraredImage(const Viewpoint& from,
                           const Illumination& light,
                           const std::vector<Reflectance>& reflectances,
                           const MatchingSensor& sensor);

/// Grey values: exposed so that one pixel of twenty is white, with the noise of light (growing with
/// its root) and of reading.
Image<std::uint8_t> exposed(const Image<float>& brightness,
                            const MatchingSensor& sensor,
                            std::uint64_t seed);

/// The stored image of a speckle sensor: the dots as a camera in the projector's place sees them on
/// a white wall; it reaches beyond the camera's image to the left by the largest disparity.
Image<std::uint8_t> storedPattern(const DotPattern& dots,
                                  const Camera& camera,
                                  const MatchingSensor& sensor);

/// Convolution with a Gaussian, the border repeated; nothing for a deviation of 0.
Image<float> blurred(const Image<float>& image, double deviation_px);

}  // namespace rangepose
