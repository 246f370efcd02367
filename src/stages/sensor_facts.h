// What a sensor does to the surfaces that it measures.
#pragma once

namespace rangepose {

/// Zeros where an image shows too little to tell.
struct SensorFacts {
  double noise_mm = 0.0;  ///< standard deviation of the error of a pixel against its neighbours,
                          ///< that of the steps of depth included [mm]
  double error_mm = 0.0;  ///< of a pixel against the smoothest surface around it, 19 px wide: what
                          ///< neighbours share is in it; once to three times noise_mm, or as the
                          ///< camera states [mm]
  double step_mm = 0.0;   ///< depth comes in steps of it; 0: none to be seen [mm]
  double jump_px = 0.0;   ///< a jump of depth is smeared over so many pixels: those between 15 and
                          ///< 85 % of it, the median of all jumps [px]
  double hole_px = 0.0;   ///< lost pixels at a jump, the mean of all jumps [px]
  double lost = 0.0;      ///< share of the pixels between measured ones that are lost, 0..1
};

}  // namespace rangepose
