#include "peers/ppf_estimate.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "pipeline/foreground_task.h"
#include "pipeline/pose_distance.h"
#include "pipeline/selection.h"
#include "stages/foreground_host.h"

namespace rangepose::peers {
namespace {

const Pose& poseOf(const PpfHypothesis& hypothesis) { return hypothesis.camera_from_object; }
const Pose& poseOf(const Candidate& candidate) { return candidate.pose; }

/// The first `count` that are no copies of one before.
template <typename Found>
std::vector<Found> different(const std::vector<Found>& found,
                             const ReferenceObject& object,
                             std::size_t count,
                             double same) {
  PoseList known(object);
  std::vector<Found> kept;
  for (const Found& one : found) {
    if (kept.size() >= count) break;
    if (known.holds(same, poseOf(one))) continue;
    known.add(poseOf(one));
    kept.push_back(one);
  }
  return kept;
}

void sortByRank(std::vector<Candidate>& poses) {
  std::stable_sort(poses.begin(), poses.end(), [](const Candidate& a, const Candidate& b) {
    return a.rank > b.rank;
  });
}

void keepBest(std::vector<Candidate>& poses, int count) {
  sortByRank(poses);
  if (static_cast<int>(poses.size()) > count) poses.resize(static_cast<std::size_t>(count));
}

}  // namespace

struct PpfEstimator::Scene {
  Verdict verdict;
  Cloud cloud;    ///< all of the foreground
  Cloud matched;  ///< of it what pairs are made of
  Cloud aligned;  ///< of it what ICP aligns to
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

std::vector<Candidate> PpfEstimator::estimate(const DepthImage& measured,
                                              const std::optional<BinBox>& bin) {
  constexpr int kNormalReach = 3;
  constexpr double kIcpSpacing = 0.012;  // [share of the diameter]
  const Foreground foreground = host::foreground(measured, foregroundTaskFor(database_, bin));
  const DepthImage& depth = foreground.depth;
  const double noise_mm = foreground.noise_mm;
  const Enclosure enclosure(depth, foreground.background, bin, database_, noise_mm);
  Scene scene{Verdict(depth, database_, enclosure, noise_mm),
              cloudOf(depth, foreground.mask, kNormalReach),
              {},
              {}};
  std::vector<Candidate> poses;
  for (std::size_t object = 0; object < database_.objects.size(); ++object) {
    scene.matched = thinned(scene.cloud, matchers_[object].front()->spacingMm());
    scene.aligned = thinned(scene.cloud, kIcpSpacing * database_.objects[object].diameter_mm);
    const std::vector<Candidate> own = search(scene, object);
    poses.insert(poses.end(), own.begin(), own.end());
  }
  Selection selection(depth, database_, noise_mm);
  selection.add(poses);
  std::vector<Candidate> chosen = selection.choose();
  std::erase_if(chosen,
                [&](const Candidate& one) { return !(one.confidence >= options_.min_score); });
  return chosen;
}

std::vector<Candidate> PpfEstimator::search(const Scene& scene, std::size_t index) {
  constexpr double kSame = 0.03;  // [share of the diameter]
  const ReferenceObject& object = database_.objects[index];
  const std::vector<glm::dvec3> seeds =
      spreadSeeds(scene.matched, options_.seeds_apart * object.diameter_mm, options_.most_seeds);
  std::vector<std::vector<Candidate>> found(seeds.size());
  const auto workers = static_cast<std::size_t>(options_.workers);
  parallelFor(options_.workers, 1, [&](int begin, int end) {
    for (int worker = begin; worker < end; ++worker) {
      const auto first = static_cast<std::size_t>(worker);
      for (std::size_t i = first; i < seeds.size(); i += workers) {
        found[i] = searchCrop(scene, index, seeds[i], *matchers_[index][first]);
      }
    }
  });
  std::vector<Candidate> poses;
  for (const auto& of_seed : found) poses.insert(poses.end(), of_seed.begin(), of_seed.end());
  // Crops overlap: a part is found from several seeds, and aligned finally once.
  sortByRank(poses);
  poses = different(poses, object, poses.size(), kSame);
  parallelFor(static_cast<int>(poses.size()), 1, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) alignFinally(scene, poses[static_cast<std::size_t>(i)]);
  });
  return poses;
}

std::vector<Candidate> PpfEstimator::searchCrop(const Scene& scene,
                                                std::size_t index,
                                                const glm::dvec3& seed,
                                                PpfMatcher& matcher) const {
  constexpr PpfIcpOptions kShort{30, 0.01f, 2.5f, 3};
  constexpr int kPoints = 250;
  constexpr double kReach = 0.1;  // [share of the diameter]
  constexpr double kSame = 0.08;  // [share of the diameter]
  const ReferenceObject& object = database_.objects[index];
  const double diameter_mm = object.diameter_mm;
  const Cloud crop = cropped(scene.matched, seed, options_.crop_radius * diameter_mm);
  const std::vector<PpfHypothesis> hypotheses =
      different(matcher.match(crop), object, static_cast<std::size_t>(options_.glanced), kSame);
  std::vector<Candidate> poses;
  poses.reserve(hypotheses.size());
  for (const PpfHypothesis& hypothesis : hypotheses) {
    Candidate& pose = poses.emplace_back();
    pose.object = static_cast<int>(index);
    pose.pose = hypothesis.camera_from_object;
    scene.verdict.glance(pose);
  }
  keepBest(poses, options_.aligned);
  // A part that the seed lies on reaches up to a diameter far, beyond the crop.
  const Cloud target = cropped(scene.aligned, seed, 1.05 * diameter_mm);
  for (Candidate& pose : poses) {
    const Cloud surface = scene.verdict.visible(pose, kReach * diameter_mm, kPoints);
    pose.pose = matcher.align(surface, target, pose.pose, kShort);
    scene.verdict.judge(pose);
  }
  keepBest(poses, options_.finalists);
  return poses;
}

void PpfEstimator::alignFinally(const Scene& scene, Candidate& pose) const {
  constexpr PpfIcpOptions kLong{100, 0.0005f, 2.5f, 3};
  constexpr int kPoints = 900;
  const auto index = static_cast<std::size_t>(pose.object);
  const ReferenceObject& object = database_.objects[index];
  const Cloud target = cropped(scene.aligned, pose.pose * object.center_mm, 1.1 * object.radius_mm);
  // What is visible changes a little with the pose: twice, with a smaller reach.
  for (const double reach : {0.06, 0.04}) {
    const Cloud surface = scene.verdict.visible(pose, reach * object.diameter_mm, kPoints);
    pose.pose = matchers_[index].front()->align(surface, target, pose.pose, kLong);
  }
  scene.verdict.judge(pose);
}

}  // namespace rangepose::peers
