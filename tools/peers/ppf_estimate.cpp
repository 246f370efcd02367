#include "peers/ppf_estimate.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "pipeline/depth_noise.h"
#include "pipeline/foreground.h"
#include "pipeline/pose_distance.h"

namespace rangepose::peers {
namespace {

/// As in the estimate of rangepose.
Image<std::uint8_t> foregroundOf(const DepthImage& depth,
                                 const std::optional<BinBox>& bin,
                                 const ReferenceDatabase& database) {
  ForegroundOptions options;
  options.part_mm = 0.0;
  for (const ReferenceObject& object : database.objects)
    options.part_mm = std::max(options.part_mm, object.diameter_mm);
  options.tolerance_mm = std::max(1.5, 0.02 * options.part_mm);
  return foregroundMask(depth, findBackground(depth, options), bin, options);
}

/// The first `count` that are no copies of one before.
std::vector<PpfHypothesis> different(const std::vector<PpfHypothesis>& hypotheses,
                                     const ReferenceObject& object,
                                     int count) {
  constexpr double kSame = 0.08;
  const PoseDistance distance(object);
  std::vector<PpfHypothesis> kept;
  for (const PpfHypothesis& hypothesis : hypotheses) {
    if (static_cast<int>(kept.size()) >= count) break;
    const bool known = std::any_of(kept.begin(), kept.end(), [&](const PpfHypothesis& other) {
      return distance.below(kSame, other.camera_from_object, hypothesis.camera_from_object);
    });
    if (!known) kept.push_back(hypothesis);
  }
  return kept;
}

void keepBest(std::vector<Scored>& poses, int count) {
  std::stable_sort(poses.begin(), poses.end(), [](const Scored& a, const Scored& b) {
    return a.score > b.score;
  });
  if (static_cast<int>(poses.size()) > count) poses.resize(static_cast<std::size_t>(count));
}

}  // namespace

struct PpfEstimator::Scene {
  Verdict verdict;
  Cloud cloud;  ///< all of the foreground
};

PpfEstimator::PpfEstimator(const ReferenceDatabase& database, const PpfEstimateOptions& options)
    : database_(database), options_(options), matchers_(database.objects.size()) {
  for (std::size_t i = 0; i < matchers_.size(); ++i) {
    matchers_[i].resize(static_cast<std::size_t>(options.workers));
    parallelFor(options.workers, 1, [&](int begin, int end) {
      for (int worker = begin; worker < end; ++worker) {
        matchers_[i][static_cast<std::size_t>(worker)] =
            std::make_unique<PpfMatcher>(database.objects[i], options.ppf);
      }
    });
  }
}

std::vector<Scored> PpfEstimator::estimate(const DepthImage& depth,
                                           const std::optional<BinBox>& bin) {
  constexpr int kNormalReach = 3;
  const Image<std::uint8_t> everything(depth.depth_mm.width(), depth.depth_mm.height(), 1);
  const Scene scene{Verdict(depth, estimateDepthNoise(depth, everything)),
                    cloudOf(depth, foregroundOf(depth, bin, database_), kNormalReach)};
  std::vector<Scored> poses;
  for (std::size_t object = 0; object < database_.objects.size(); ++object) {
    const std::vector<Scored> own = search(scene, object);
    poses.insert(poses.end(), own.begin(), own.end());
  }
  return scene.verdict.withoutRivals(std::move(poses), database_.objects, options_.min_score);
}

std::vector<Scored> PpfEstimator::search(const Scene& scene, std::size_t object) {
  const double diameter_mm = database_.objects[object].diameter_mm;
  const Cloud thin = thinned(scene.cloud, matchers_[object].front()->spacingMm());
  const std::vector<glm::dvec3> seeds =
      spreadSeeds(thin, options_.seeds_apart * diameter_mm, options_.most_seeds);
  std::vector<std::vector<Scored>> found(seeds.size());
  parallelFor(options_.workers, 1, [&](int begin, int end) {
    for (int worker = begin; worker < end; ++worker) {
      const auto first = static_cast<std::size_t>(worker);
      for (std::size_t i = first; i < seeds.size(); i += matchers_[object].size()) {
        found[i] = searchCrop(scene, object, seeds[i], *matchers_[object][first]);
      }
    }
  });
  std::vector<Scored> poses;
  for (const auto& of_seed : found) poses.insert(poses.end(), of_seed.begin(), of_seed.end());
  return poses;
}

std::vector<Scored> PpfEstimator::searchCrop(const Scene& scene,
                                             std::size_t index,
                                             const glm::dvec3& seed,
                                             PpfMatcher& matcher) const {
  constexpr PpfIcpOptions kShort{30, 0.01f, 2.5f, 3};
  constexpr PpfIcpOptions kLong{100, 0.0005f, 2.5f, 3};
  constexpr int kFewPoints = 250;
  constexpr int kManyPoints = 900;
  constexpr double kSceneSpacing = 0.012;  // for ICP [share of the diameter]
  const ReferenceObject& object = database_.objects[index];
  const double diameter_mm = object.diameter_mm;
  const Cloud around = cropped(scene.cloud, seed, options_.crop_radius * diameter_mm);
  const std::vector<PpfHypothesis> hypotheses =
      different(matcher.match(thinned(around, matcher.spacingMm())), object, options_.glanced);
  std::vector<Scored> poses;
  for (const PpfHypothesis& hypothesis : hypotheses) {
    poses.push_back({static_cast<int>(index),
                     hypothesis.camera_from_object,
                     scene.verdict.glance(object, hypothesis.camera_from_object)});
  }
  keepBest(poses, options_.aligned);
  // A part that the seed lies on reaches a diameter far, beyond the crop.
  const Cloud target =
      thinned(cropped(scene.cloud, seed, 1.05 * diameter_mm), kSceneSpacing * diameter_mm);
  const auto align = [&](Scored& pose, double reach, int points, const PpfIcpOptions& icp) {
    const Cloud surface =
        scene.verdict.visible(object, pose.camera_from_object, reach * diameter_mm, points);
    pose.camera_from_object = matcher.align(surface, target, pose.camera_from_object, icp);
  };
  for (Scored& pose : poses) {
    align(pose, 0.1, kFewPoints, kShort);
    pose.score = scene.verdict.score(object, pose.camera_from_object);
  }
  keepBest(poses, options_.finalists);
  for (Scored& pose : poses) {
    align(pose, 0.06, kManyPoints, kLong);
    align(pose, 0.04, kManyPoints, kLong);
    pose.score = scene.verdict.score(object, pose.camera_from_object);
  }
  return poses;
}

}  // namespace rangepose::peers
