// From one depth image to poses: the whole method, one step a line in estimate.cpp.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/camera.h"
#include "core/timings.h"
#include "database/reference_database.h"
#include "pipeline/choice_options.h"
#include "pipeline/refine.h"
#include "pipeline/seeds.h"
#include "stages/check_host.h"
#include "stages/foreground.h"
#include "stages/icp_host.h"
#include "stages/sensor_facts.h"
#include "stages/stage_set.h"

namespace rangepose {

/// How much a pass over the scene does.
struct PassEffort {
  int starts;      ///< N_init, paper Sect. 6.1
  int iterations;  ///< of a simplex, at most; never more than SearchOptions say
  int row_step;    ///< see ErrorOptions; never less than SearchOptions say
  int kept;        ///< hypotheses of a start that are aligned with their view's own points
  int verified;    ///< of these, how many are rendered, aligned again and checked
  FineEffort fine;
};

struct EstimateOptions {
  // 0: as effort() says.
  int starts = 0;          ///< start points of a pass
  int kept_per_start = 0;  ///< see PassEffort
  int verified = 0;        ///< likewise, of each start
  double min_score = 0.5;  ///< poses below are not reported
  int max_poses = 1;  ///< poses wanted; more than one: what is explained is taken out, then again
  SearchOptions search;
  AlignOptions align;
  ChoiceOptions choice;
  /// Of the passes 0, 1, ...
  PassEffort effort(int pass = 0) const;
  void check() const;  ///< throws Error naming the bad field
};

struct PoseEstimate {
  int object = 0;            ///< index into the database
  Pose rough;                ///< camera_from_object of the winning hypothesis
  Pose pose;                 ///< camera_from_object, refined
  float rough_error = 0.0f;  ///< Eq. 1
  int view = 0;
  double confidence = 0.0;   ///< that the pose is right, 0..1
  CheckResult check;         ///< of the rendered pose
  EvidenceTerms evidence{};  ///< what the confidence comes from
};

/// Pictures of what happened to one object; for dumps and comparisons.
struct ObjectTrace {
  Image<float> raw_range_px;  ///< before the median
  SceneChannels scene;
  Image<std::int32_t> labels;
  std::vector<Seed> seeds;
  std::vector<SceneChannels> windows;
  std::vector<Hypothesis> hypotheses;  ///< of all windows and views
  // What the stages were called with, for those who call them again.
  ChannelOptions scene_options;          ///< of `scene`; windows: channelOptionsOf(object)
  std::vector<PixelBox> window_regions;  ///< depth pixels that each window was made from
  std::vector<float> seed_range_px;      ///< range at the centre of each window [px]
  SearchOptions search;
};

/// The hypothesis with the lowest Eq. 1 of all windows (paper Eq. 7), the first of equal ones; null
/// where nothing was searched.
const Hypothesis* lowestError(const ObjectTrace& trace);

struct EstimateTrace {
  Image<std::uint8_t> foreground;
  /// After the alignment with the views' own points, the best of each start, best first: all that
  /// the reference views can say, nothing rendered yet. First pass only.
  std::vector<PoseEstimate> coarse;
  std::vector<PoseEstimate> verified;  ///< checked poses, a few of each start; first pass only
  std::vector<ObjectTrace> objects;    ///< one for each object of the database; first pass only
  /// All poses that the last choice was made from, surest first, each as judged among the others:
  /// the confidence is not shared with rivals.
  std::vector<Candidate> known;
  std::vector<Candidate> chosen;  ///< those of them that were, the surest first
};

struct Estimate {
  std::vector<PoseEstimate> poses;  ///< best first; empty is a valid answer
  StageTimes times;
  SensorFacts sensor;     ///< what the image tells of it
  double noise_mm = 0.0;  ///< sensor.error_mm: what tolerances go by [mm]
  std::vector<BackgroundPlane> background;
  std::vector<std::string> warnings;  ///< one line each
};

/// Throws Error when the image has no measured pixel. `trace`, if not null, is filled.
Estimate estimatePoses(const DepthImage& depth,
                       const std::optional<BinBox>& bin,
                       const ReferenceDatabase& database,
                       const EstimateOptions& options,
                       StageSet& stages,
                       EstimateTrace* trace = nullptr);

}  // namespace rangepose
