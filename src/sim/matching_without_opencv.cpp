#include "core/error.h"
#include "sim/matching.h"

namespace rangepose {

Image<float> matchedDisparity(const Image<std::uint8_t>&,
                              const Image<std::uint8_t>&,
                              const MatchingSensor&,
                              SensorKind) {
  throw Unavailable(
      "sensor: stereo and speckle match images by OpenCV, which this program is built without; "
      "configure without RANGEPOSE_CORE_ONLY");
}

}  // namespace rangepose
