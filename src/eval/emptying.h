// The paper's experiment (Sect. 8.1.1): bins emptied one by one, each part a trial.
//
// A trial: the parts that are left are scanned, one pose is estimated, and the part nearest to it
// (smallest vertex error) is taken out, whether the pose is right or not, so that a bin of n parts
// gives n trials; a wrong pose is a failed trial. Where no pose is found, the most visible part is
// taken out. Parts do not settle anew after one is gone. A pose is right when its vertex error
// against the nearest part is below 10 % of the diagonal of the bounding box.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "core/timings.h"
#include "eval/pose_errors.h"
#include "eval/virtual_bin.h"

namespace rangepose {

inline constexpr double kRightVertexError = 0.10;  ///< of the bounding box's diagonal

/// What a method answers to one scan; empty poses where it has none.
struct TrialAnswer {
  std::optional<Pose> search;  ///< the hypothesis with the smallest error of all (paper Eq. 7)
  /// The same of a search whose range differences count without limit, as in the paper's Eq. 5.
  std::optional<Pose> unlimited;
  std::optional<Pose> rough;  ///< the best after alignment with the points of its own view
  std::optional<Pose> fine;   ///< after refinement and check
  double score = 0.0;         ///< confidence of `fine`
  StageTimes times;           ///< empty when not measured
};

/// One pose against the part nearest to it.
struct PoseGrade {
  bool right = false;
  int part = -1;              ///< index into the scan's parts; -1 without a pose
  double vertex = 0.0;        ///< vertex error [diagonals]
  double center = 0.0;        ///< distance of the centres of the bounding spheres [diagonals]
  double rotation_rad = 0.0;  ///< modulo symmetry
  glm::dvec3 euler_rad{0.0};  ///< of eulerErrorRad()
};

struct Trial {
  int bin = 0;     ///< VirtualBin::number
  int number = 0;  ///< 0 is the full bin
  PoseGrade search;
  PoseGrade unlimited;
  PoseGrade rough;
  PoseGrade fine;
  double score = 0.0;
  double visible = 0.0;       ///< visible fraction of the part nearest to `fine` (to nothing: 0)
  double best_visible = 0.0;  ///< of the most visible part
  StageTimes times;
};

using Answerer = std::function<TrialAnswer(const BinScan&)>;
/// Sees each trial after it was graded.
using TrialObserver = std::function<void(const Trial&, const BinScan&, const TrialAnswer&)>;

/// Grades one pose against the parts of a scan.
PoseGrade gradePose(const ErrorModel& model, const BinScan& scan, const std::optional<Pose>& pose);

/// As many trials as the bin has parts. `observe` may be empty.
std::vector<Trial> emptyBin(const VirtualBin& bin,
                            const ErrorModel& model,
                            const BinScanOptions& options,
                            const Answerer& answer,
                            const TrialObserver& observe);

}  // namespace rangepose
