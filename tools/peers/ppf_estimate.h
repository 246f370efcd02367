// All parts of one depth image by OpenCV's surface_matching, set up as well as we can: a crop
// around each of many seeds, the best poses of each aligned by its ICP, ranked by what the image
// says.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "database/reference_database.h"
#include "peers/ppf_matcher.h"
#include "peers/verdict.h"

namespace rangepose::peers {

struct PpfEstimateOptions {
  PpfOptions ppf;
  double seeds_apart = 0.35;  ///< [share of the diameter]
  int most_seeds = 80;        ///< of an object
  double crop_radius = 0.5;   ///< around a seed [share of the diameter]
  int glanced = 40;        ///< hypotheses of a crop with the most votes, different ones, looked at
  int aligned = 8;         ///< of those the ones that explain most are aligned
  int finalists = 2;       ///< aligned ones of a crop that are aligned again, with more points
  double min_score = 0.5;  ///< poses below are not reported
  int workers = 1;         ///< threads; the result does not depend on it
};

class PpfEstimator {
 public:
  /// Trains `workers` matchers for each object. The database must outlive it.
  PpfEstimator(const ReferenceDatabase& database, const PpfEstimateOptions& options);

  /// Best first. Background is taken out as rangepose does it.
  std::vector<Candidate> estimate(const DepthImage& depth, const std::optional<BinBox>& bin);

 private:
  struct Scene;
  /// Aligned and scored poses of an object.
  std::vector<Candidate> search(const Scene& scene, std::size_t object);
  /// The finalists around a seed, roughly aligned.
  std::vector<Candidate> searchCrop(const Scene& scene,
                                    std::size_t object,
                                    const glm::dvec3& seed,
                                    PpfMatcher& matcher) const;
  void alignFinally(const Scene& scene, Candidate& pose) const;

  const ReferenceDatabase& database_;
  PpfEstimateOptions options_;
  std::vector<std::vector<std::unique_ptr<PpfMatcher>>> matchers_;  ///< [object][worker]
};

}  // namespace rangepose::peers
