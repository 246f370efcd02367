// From the hypotheses of the rough search to checked poses (paper Sect. 7).
#pragma once

#include <vector>

#include "database/reference_database.h"
#include "pipeline/align_options.h"
#include "pipeline/enclosure.h"
#include "pipeline/evidence.h"
#include "stages/check_host.h"
#include "stages/stage_set.h"

namespace rangepose {

/// What refinement needs to know of a scene.
struct RefineScene {
  const DepthImage& depth;        ///< as measured: for the check
  const ResidentDepth& resident;  ///< it and the same without background, for the alignment
  double noise_mm;                ///< of the depth [mm]
  const Enclosure& enclosure;     ///< of the same image and database
  StageSet& stages;               ///< of the path that `resident` is from
  AlignOptions align{};
};

/// A rough pose and what became of it.
struct Candidate {
  int object = 0;
  int view = 0;
  int window = 0;  ///< number of the start
  float rough_error = 0.0f;
  Pose rough;
  Pose pose;
  CheckResult check;
  double outside = 0.0;      ///< Enclosure::outsideShare, once rendered and checked
  EvidenceTerms evidence{};  ///< likewise
  /// What candidates are ordered by: score and how much of the scene it explains; once rendered and
  /// checked the log odds of being right.
  double rank = 0.0;
  double confidence = 0.0;  ///< 0..1, once rendered and checked
};

/// The `count` most promising hypotheses of each window that differ from each other, as poses: half
/// by the error of the rough search, half by a glance at the depth image. `cameras` are those of
/// the windows.
std::vector<Candidate> bestCandidates(const ReferenceObject& object,
                                      int object_index,
                                      const std::vector<Hypothesis>& hypotheses,
                                      const std::vector<OrthoCamera>& cameras,
                                      const RefineScene& scene,
                                      int count);

/// Aligns the candidates with the points of their own views and gives the `count` best of each
/// start.
std::vector<Candidate> refineCoarsely(std::vector<Candidate> candidates,
                                      const ReferenceDatabase& database,
                                      const RefineScene& scene,
                                      int count);

/// The same for turned copies of aligned poses: where a part is nearly the same again, a copy is
/// right as it is, and what starts at a distance would lead it astray. So each is there as it was,
/// too.
std::vector<Candidate> refineTurned(const std::vector<Candidate>& copies,
                                    const ReferenceDatabase& database,
                                    const RefineScene& scene,
                                    int count);

/// The `count` best candidates of each start that differ from each other: a start on something else
/// may have candidates that look better than those of the start on the part.
std::vector<Candidate> bestDistinct(std::vector<Candidate> candidates,
                                    const ReferenceDatabase& database,
                                    int count);

/// How much is done for a checked pose.
struct FineEffort {
  int rounds;     ///< of rendering and alignment before the finalists are chosen
  int points;     ///< of a surface in these rounds
  int finalists;  ///< of each start, that are aligned until they rest
  double still;   ///< a pose that moves by less in a round rests [share of the diameter]
};

/// Renders candidates of refineCoarsely at the sensor's resolution, aligns the visible part, and
/// checks the result; keeps the few best of each start and aligns those until they rest. Candidates
/// are dropped that explain next to nothing, or are beyond hope after the first check.
void refineFinely(std::vector<Candidate>& candidates,
                  const ReferenceDatabase& database,
                  const RefineScene& scene,
                  const FineEffort& effort);

/// Aligns checked poses that the image hardly tells apart until they rest, each pair within half of
/// the tolerance, and checks them again: what tells them apart may be less than what they are off.
void refineTies(std::vector<Candidate>& candidates,
                const ReferenceDatabase& database,
                const RefineScene& scene);

/// Checks turned copies of poses that are free to turn, drops those that are beyond hope, and
/// aligns the others as refineTies() does: what tells them apart is little.
void checkFreeTurns(std::vector<Candidate>& candidates,
                    const ReferenceDatabase& database,
                    const RefineScene& scene);

/// Checks twins of settled poses (geometry/twins.h), drops those that are beyond hope, and brings
/// the others to rest as long as they stay where they are: where the image leaves them some
/// freedom, each would come to rest elsewhere, by more than what tells one from the other.
void checkTwins(std::vector<Candidate>& candidates,
                const ReferenceDatabase& database,
                const RefineScene& scene);

/// Surfaces of an object closer than this count as the same [mm].
double toleranceFor(const ReferenceObject& object, double noise_mm);

/// Brings checked poses to rest where all of their pixels fit best, and checks them again: each
/// pixel that shows the part is aligned with the depth measured on its own ray. Rims, which are
/// known to a part of a pixel only, have no say, nor has which neighbour lies nearer, which is
/// noise. For poses that are right but for a part of the tolerance.
void settle(std::vector<Candidate>& candidates,
            const ReferenceDatabase& database,
            const RefineScene& scene);

}  // namespace rangepose
