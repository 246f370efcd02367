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

/// What a sensor that matches infrared images is made of. Pixels are those of the image that is
/// taken, whatever its size; only the disparities that are tried follow the focal length.
struct MatchingSensor {
  double projector_mm = 0.0;    ///< of stereo, from the camera along its x; speckle: the baseline
  double dot_spacing_px = 5.0;  ///< of the pattern, on average
  double dot_px = 0.9;          ///< deviation of a dot's profile
  double blur_px = 0.6;         ///< deviation of the lens's point spread
  double ambient = 0.1;         ///< light of the room, of that of a dot's middle at 1 m
  double image_noise = 2.0;     ///< deviation of a grey value at full exposure, of 255
  int columns = 1;              ///< that are matched for each pixel: finer than depth is delivered
  int window_px = 9;            ///< width of what is matched, odd; of these columns
  double smoothness = 1.0;      ///< of semi-global matching: penalties, of OpenCV's usual ones
  int uniqueness_percent = 10;  ///< the best match must be better than all others by this
  double least_contrast = 0.0;  ///< deviation of grey values in a window; pixels with less are lost
  int least_disparity_px = 0;
  int disparities = 128;           ///< tried from the least one, a multiple of 16
  double disparity_step = 0.0625;  ///< as matched [px], at least OpenCV's 1/16
  int agreement_px = 1;            ///< both ways of matching may differ by this
  int speckle_px = 100;            ///< smaller patches of disparity are dropped
  double smoothing_px = 0.0;       ///< deviation of the device's own smoothing, also across jumps
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
