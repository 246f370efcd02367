#include "sim/sensor_model.h"

#include <algorithm>

#include "core/error.h"

namespace rangepose {
namespace {

SensorModel structuredLight(int level) {
  SensorModel model;
  model.noise = sensorNoise(level);
  return model;
}

SensorModel ideal() {
  SensorModel model;
  model.kind = SensorKind::kNone;
  return model;
}

/// RealSense D435: f 422 px and baseline 50 mm at 848x480, depth in steps of 1 mm as delivered.
/// What its images and its matching are like was chosen so that scans of pipe elbows have the
/// statistics of real ones (docs/sensors.md).
SensorModel realsenseD435() {
  SensorModel model;
  model.kind = SensorKind::kStereo;
  model.width = 848;
  model.fx = model.fy = 422.0;
  model.baseline_mm = 50.0;
  model.nearest_mm = 280.0;
  model.depth_scale = 1.0;
  model.matching.projector_mm = 30.0;
  model.matching.dot_spacing_px = 6.0;
  model.matching.dot_px = 1.0;
  model.matching.blur_px = 0.7;
  model.matching.ambient = 0.2;
  model.matching.image_noise = 14.0;
  model.matching.smoothness = 0.2;
  model.matching.uniqueness_percent = 20;
  model.matching.least_contrast = 36.0;
  model.matching.least_disparity_px = 8;
  model.matching.speckle_px = 200;
  model.matching.smoothing_px = 2.2;
  return model;
}

/// RealSense D415: f 925 px and baseline 55 mm at 1280x720. Matched as by a D435.
SensorModel realsenseD415() {
  SensorModel model = realsenseD435();
  model.width = 1280;
  model.height = 720;
  model.fx = model.fy = 925.0;
  model.baseline_mm = 55.0;
  model.nearest_mm = 450.0;
  model.matching.projector_mm = 25.0;
  return model;
}

/// Kinect of 2010, PrimeSense: disparity in steps of 1/8 px, baseline 75 mm (Khoshelham and
/// Elberink, Sensors 12:1437, 2012). The rest was chosen as that of the D435, on scans of blocks.
SensorModel kinectV1() {
  SensorModel model;
  model.kind = SensorKind::kSpeckle;
  model.fx = model.fy = 580.0;
  model.depth_scale = 1.0;
  model.nearest_mm = 500.0;
  model.matching.dot_spacing_px = 3.2;
  model.matching.dot_px = 0.8;
  model.matching.least_disparity_px = 16;
  model.matching.disparities = 112;
  model.matching.disparity_step = 0.125;
  model.matching.columns = 2;
  model.matching.window_px = 11;
  model.matching.smoothness = 1.2;
  model.matching.uniqueness_percent = 0;
  model.matching.agreement_px = 2;
  model.matching.speckle_px = 40;
  model.matching.image_noise = 10.0;
  model.matching.least_contrast = 6.0;
  return model;
}

/// Azure Kinect, narrow field of view, unbinned.
SensorModel azureKinect() {
  SensorModel model;
  model.kind = SensorKind::kTimeOfFlight;
  model.height = 576;
  model.fx = model.fy = 504.0;
  model.depth_scale = 1.0;
  model.nearest_mm = 500.0;
  return model;
}

/// Kinect of 2013.
SensorModel kinectV2() {
  SensorModel model = azureKinect();
  model.width = 512;
  model.height = 424;
  model.fx = model.fy = 365.0;
  model.tof.sigma_mm = 1.2;
  return model;
}

/// Helios2: a field of view of 69 x 51 degrees.
SensorModel helios2() {
  SensorModel model = azureKinect();
  model.height = 480;
  model.fx = model.fy = 466.0;
  model.depth_scale = 0.25;
  model.nearest_mm = 400.0;
  model.tof.modulation_mhz = 100.0;
  model.tof.sigma_mm = 0.6;
  return model;
}

/// Zivid Two with pixels in blocks of 2x2: 754 mm in 1944 px at 700 mm, points to 0.06 mm there.
SensorModel zividTwo() {
  SensorModel model = structuredLight(1);
  model.width = 972;
  model.height = 600;
  model.fx = model.fy = 902.0;
  model.depth_scale = 0.05;
  model.baseline_mm = 113.0;
  model.nearest_mm = 300.0;
  model.noise.sigma_mm = 0.12;
  return model;
}

/// Pixels twice as long down the image as across it; a line is either seen or not.
SensorModel laser() {
  SensorModel model;
  model.kind = SensorKind::kLaser;
  model.height = 240;
  model.fy = 0.5 * model.fx;
  model.depth_scale = 0.05;
  model.baseline_mm = 150.0;
  model.noise.sigma_mm = 0.1;
  model.noise.edge_loss = 0.4;
  model.noise.edge_mix = 0.05;
  model.noise.grazing_cosine = 0.25;
  model.noise.random_loss = 0.001;
  return model;
}

struct Preset {
  const char* name;
  const char* summary;
  SensorModel (*make)();
};

constexpr Preset kPresets[] = {
    {"none", "depth as it is", ideal},
    {"structured-light", "a good industrial scanner", [] { return structuredLight(1); }},
    {"rough",
     "the same, 1 mm at 1 m, a tenth of all pixels lost",
     [] { return structuredLight(2); }},
    {"stereo", "two infrared cameras and dots, as realsense-d415", realsenseD415},
    {"speckle", "one infrared camera and dots, as kinect-v1", kinectV1},
    {"tof", "time of flight, as azure-kinect", azureKinect},
    {"laser", "a swept line of laser light, pixels twice as long as wide", laser},
    {"realsense-d435", "stereo, 848x480, wide", realsenseD435},
    {"realsense-d415", "stereo, 1280x720, narrow", realsenseD415},
    {"kinect-v1", "speckle, 640x480, steps of 1/8 px", kinectV1},
    {"azure-kinect", "time of flight, 640x576", azureKinect},
    {"kinect-v2", "time of flight, 512x424", kinectV2},
    {"helios2", "time of flight, 640x480", helios2},
    {"zivid-two", "structured light, 972x600", zividTwo},
};

const Preset* presetOf(const std::string& name) {
  const auto* const found = std::find_if(std::begin(kPresets),
                                         std::end(kPresets),
                                         [&](const Preset& preset) { return preset.name == name; });
  return found == std::end(kPresets) ? nullptr : found;
}

}  // namespace

const std::vector<std::string>& sensorNames() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const Preset& preset : kPresets) all.emplace_back(preset.name);
    return all;
  }();
  return names;
}

bool needsPinhole(const SensorModel& sensor) {
  return sensor.kind != SensorKind::kNone && sensor.kind != SensorKind::kStructuredLight;
}

SensorModel sensorModel(const std::string& name) {
  const Preset* const preset = presetOf(name);
  if (preset == nullptr) {
    std::string all;
    for (const std::string& known : sensorNames()) all += (all.empty() ? "" : ", ") + known;
    throw Error("sensor " + name + ": not known; name one of " + all);
  }
  SensorModel model = preset->make();
  model.name = name;
  return model;
}

std::string sensorSummary(const std::string& name) {
  const Preset* const preset = presetOf(name);
  return preset == nullptr ? std::string() : preset->summary;
}

}  // namespace rangepose
