// Depth sensors by how they measure, and presets of real devices.
#pragma once

#include <string>
#include <vector>

#include "sim/sensor_noise.h"

namespace rangepose {

enum class SensorKind {
  kNone,             ///< depth as it is
  kStructuredLight,  ///< each pixel decodes the projector's column that lights it
  kStereo,           ///< two infrared cameras, a projected pattern of dots, matched windows
  kSpeckle,          ///< one infrared camera, its image of the dots matched to a stored one
  kTimeOfFlight,     ///< phase of modulated light, by pixel
  kLaser,            ///< a line of laser light that sweeps down the image
};

/// What a sensor that matches infrared images is made of. Pixels are those of an image as wide as
/// the sensor's own; in an image of another size all of them scale with its width.
struct MatchingSensor {
  double projector_mm = 0.0;    ///< from the camera along its x
  double dot_spacing_px = 5.0;  ///< of the pattern, on average
  double dot_px = 0.9;          ///< deviation of a dot's profile
  double blur_px = 0.6;         ///< deviation of the lens's point spread
  double ambient = 0.1;         ///< light of the room, of that of a dot's middle
  double image_noise = 2.0;     ///< deviation of a grey value at full exposure, of 255
  int window_px = 9;            ///< width of what is matched, odd
  double smoothness = 1.0;      ///< of semi-global matching: penalties, of OpenCV's usual ones
  int uniqueness_percent = 10;  ///< the best match must be better than all others by this
  int least_disparity_px = 0;
  int disparities = 128;           ///< tried from the least one, a multiple of 16
  double disparity_step = 0.0625;  ///< of the result [px], at least OpenCV's 1/16
  int speckle_px = 100;            ///< smaller patches of disparity are dropped
};

/// Phase of light, mixed by the lens and by what parts reflect onto each other.
struct TimeOfFlightSensor {
  double modulation_mhz = 80.0;
  double blur_px = 0.6;        ///< deviation of the lens's point spread
  double sigma_mm = 0.8;       ///< deviation at 1 m of a white surface that faces the camera
  double bias_mm = 2.0;        ///< how much farther a surface of a tenth of white's light seems
  double wiggle_mm = 0.5;      ///< of the periodic error of depth
  double least_signal = 0.02;  ///< of a white surface that faces the camera at 1 m
};

struct SensorModel {
  std::string name;
  SensorKind kind = SensorKind::kStructuredLight;
  int width = 640;            ///< of its image [px]
  int height = 480;           ///< [px]
  double fx = 570.0;          ///< [px], of an image of that size
  double fy = 570.0;          ///< [px], of an image of that size
  double depth_scale = 0.1;   ///< step of the stored depth [mm]
  double baseline_mm = 75.0;  ///< to the projector or second camera, along x; laser: along y
  double nearest_mm = 0.0;    ///< a camera that is to see all of a bin stays at least so far away
  SensorNoise noise;          ///< of structured light and laser
  MatchingSensor matching;    ///< of stereo and speckle
  TimeOfFlightSensor tof;
};

/// Whether it can't take orthographic images.
bool needsPinhole(const SensorModel& sensor);

/// none, structured-light, rough, stereo, speckle, tof, laser, and devices by name. Throws Error
/// with all names for another one.
SensorModel sensorModel(const std::string& name);

/// The names that sensorModel() takes; kinds first.
const std::vector<std::string>& sensorNames();

/// What it is, in a few words, for help texts.
std::string sensorSummary(const std::string& name);

}  // namespace rangepose
