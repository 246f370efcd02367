#include "compare/compare.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <sstream>

#include "compare/isolated.h"
#include "compare/search_stages.h"
#include "compare/tally.h"
#include "geometry/orientation_grid.h"
#include "stages/reference_host.h"

namespace rangepose {
namespace {

/// What one path makes of the image all by itself.
struct Run {
  Estimate estimate;
  EstimateTrace trace;
  double ms = 0.0;
  double msOf(const std::string& stage) const {
    for (const StageTime& time : estimate.times) {
      if (time.stage == stage) return time.ms;
    }
    return 0.0;
  }
};

/// Mean distance between the same vertex at two poses [mm].
double vertexDistance(const Mesh& mesh, const Pose& a, const Pose& b) {
  double sum = 0.0;
  for (const glm::vec3& vertex : mesh.vertices) {
    sum += glm::distance(a * glm::dvec3(vertex), b * glm::dvec3(vertex));
  }
  return mesh.vertices.empty() ? 0.0 : sum / static_cast<double>(mesh.vertices.size());
}

/// Mean distance along the viewing direction between the surfaces of an object at two poses [mm],
/// seen from several sides; infinite where the outlines differ by more than a few pixels. Of a
/// symmetric part several poses lay the same surface, and which one wins may hang on the last bit
/// of a score.
double surfaceDistance(const ReferenceObject& object, const Pose& a, const Pose& b) {
  constexpr int kSides = 6;
  constexpr double kMaxOutlineShare = 0.03;
  const Camera camera = tileCamera(object);
  const SurfaceWindow window{0, 0, object.size, object.size, 1};
  const Pose a_from_b = a.inverse() * b;
  double sum = 0.0;
  int both = 0;
  int one = 0;
  for (const glm::dmat3& side : uniformRotations(kSides)) {
    const Pose pose = tilePose(object, side);
    const Image<SurfaceTexel> first = host::renderSurface(object.mesh, camera, pose, window);
    const Image<SurfaceTexel> second =
        host::renderSurface(object.mesh, camera, pose * a_from_b, window);
    for (std::size_t i = 0; i < first.size(); ++i) {
      const float depth_a = first.data()[i].w;
      const float depth_b = second.data()[i].w;
      if (depth_a == 0.0f && depth_b == 0.0f) continue;
      const bool seen_by_both = depth_a != 0.0f && depth_b != 0.0f;
      (seen_by_both ? both : one) += 1;
      if (seen_by_both) sum += static_cast<double>(std::abs(depth_a - depth_b));
    }
  }
  if (both == 0 || one > kMaxOutlineShare * both) return std::numeric_limits<double>::infinity();
  return sum / both;
}

double degreesBetween(const Pose& a, const Pose& b) {
  return rotationAngleBetween(a.rotation, b.rotation) * 180.0 / std::numbers::pi;
}

void tallyChannels(const SceneChannels& a, const SceneChannels& b, Tally& tally) {
  tally.addImages(a.range_px, b.range_px);
  tally.addImages(a.edges, b.edges);
  tally.addImages(a.distance_px, b.distance_px);
}

class Chained {
 public:
  Chained(const ReferenceDatabase& database,
          const Run& reference,
          const Run& subject,
          const std::string& path)
      : database_(database), reference_(reference), subject_(subject), path_(path) {
    foreground_.addLabels(reference.trace.foreground, subject.trace.foreground);
    for (std::size_t i = 0; i < reference.trace.objects.size(); ++i) {
      compareObject(reference.trace.objects[i], subject.trace.objects[i]);
    }
    comparePoses();
    const auto time = [&](Tally& tally, const char* stage) {
      tally.addTimes(reference.msOf(stage), subject.msOf(stage));
    };
    time(foreground_, "foreground");
    time(scene_, "scene and starts");
    time(windows_, "windows");
    time(errors_, "rough search");
    position_.addTimes(reference.ms, subject.ms);
  }

  std::vector<StageComparison> results() const {
    std::vector<StageComparison> all;
    for (const Tally* tally : {&foreground_,
                               &scene_,
                               &patches_,
                               &starts_,
                               &windows_,
                               &errors_,
                               &winners_,
                               &position_,
                               &rotation_,
                               &score_}) {
      all.push_back(tally->result());
    }
    return all;
  }

 private:
  void compareObject(const ObjectTrace& expected, const ObjectTrace& actual) {
    tallyChannels(expected.scene, actual.scene, scene_);
    patches_.addLabels(expected.labels, actual.labels);
    for (std::size_t i = 0; i < std::min(expected.seeds.size(), actual.seeds.size()); ++i) {
      const Seed& a = expected.seeds[i];
      const Seed& b = actual.seeds[i];
      starts_.add(static_cast<double>(glm::distance(glm::vec3(a.x_px, a.y_px, a.range_px),
                                                    glm::vec3(b.x_px, b.y_px, b.range_px))));
    }
    starts_.addMissing(surplus(expected.seeds.size(), actual.seeds.size()));
    for (std::size_t i = 0; i < std::min(expected.windows.size(), actual.windows.size()); ++i) {
      tallyChannels(expected.windows[i], actual.windows[i], windows_);
    }
    tallyHypotheses(expected.hypotheses, actual.hypotheses, errors_, winners_);
  }

  void comparePoses() {
    const std::vector<PoseEstimate>& expected = reference_.estimate.poses;
    const std::vector<PoseEstimate>& actual = subject_.estimate.poses;
    for (std::size_t i = 0; i < std::min(expected.size(), actual.size()); ++i) {
      const PoseEstimate& a = expected[i];
      const PoseEstimate& b = actual[i];
      addPoses(database_.objects[static_cast<std::size_t>(a.object)], a, b);
      score_.add(std::abs(a.check.score - b.check.score));
    }
    position_.addMissing(surplus(expected.size(), actual.size()));
  }

  void addPoses(const ReferenceObject& object, const PoseEstimate& a, const PoseEstimate& b) {
    if (a.object != b.object) {
      position_.add(kIncomparable);
      rotation_.add(kIncomparable);
      return;
    }
    const double vertices_mm = vertexDistance(object.mesh, a.pose, b.pose);
    const double surfaces_mm = surfaceDistance(object, a.pose, b.pose);
    const bool symmetric =
        vertices_mm > 0.1 * object.diameter_mm && surfaces_mm < 0.01 * object.diameter_mm;
    position_.add(symmetric ? surfaces_mm : vertices_mm);
    // What a symmetry turns is no difference; a turn on top of it shows in the surfaces.
    rotation_.add(symmetric ? 0.0 : degreesBetween(a.pose, b.pose));
  }

  const ReferenceDatabase& database_;
  const Run& reference_;
  const Run& subject_;
  const std::string path_;
  Tally foreground_{"whole foreground", path_};
  Tally scene_{"scene", path_};
  Tally patches_{"scene patches", path_};
  Tally starts_{"starts", path_};
  Tally windows_{"windows", path_};
  Tally errors_{"rough errors", path_};
  Tally winners_{"rough winners", path_};
  Tally position_{"pose position", path_};
  Tally rotation_{"pose rotation", path_};
  Tally score_{"pose score", path_};
};

std::string winnerText(const Hypothesis* winner) {
  if (winner == nullptr) return "nothing";
  std::ostringstream text;
  text << "view " << winner->view << " (error " << winner->error << ")";
  return text.str();
}

std::vector<std::string> verdictOf(const Comparison& comparison,
                                   const ReferenceDatabase& database,
                                   const Run& reference,
                                   const Run& subject) {
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < reference.trace.objects.size(); ++i) {
    const ObjectTrace& trace = reference.trace.objects[i];
    for (int start = 0; start < static_cast<int>(trace.windows.size()); ++start) {
      lines.push_back(database.objects[i].mesh.name + ", start " + std::to_string(start + 1) +
                      ": " + comparison.reference + " " +
                      winnerText(winnerOf(trace.hypotheses, start)) + ", " + comparison.subject +
                      " " + winnerText(winnerOf(subject.trace.objects[i].hypotheses, start)));
    }
  }
  const std::vector<PoseEstimate>& expected = reference.estimate.poses;
  const std::vector<PoseEstimate>& actual = subject.estimate.poses;
  for (std::size_t i = 0; i < std::min(expected.size(), actual.size()); ++i) {
    const ReferenceObject& object = database.objects[static_cast<std::size_t>(expected[i].object)];
    std::ostringstream line;
    line.precision(4);
    line << object.mesh.name << ", pose " << i + 1 << ": view " << expected[i].view << " and "
         << actual[i].view << ", score " << expected[i].check.score << " and "
         << actual[i].check.score << ", "
         << vertexDistance(object.mesh, expected[i].pose, actual[i].pose) << " mm and "
         << degreesBetween(expected[i].pose, actual[i].pose) << " degrees apart";
    lines.push_back(line.str());
  }
  if (expected.empty() && actual.empty()) lines.emplace_back("no pose on either path");
  if (expected.size() != actual.size()) {
    lines.push_back(std::to_string(expected.size()) + " poses on " + comparison.reference + ", " +
                    std::to_string(actual.size()) + " on " + comparison.subject);
  }
  lines.push_back(comparison.first_out_of_tolerance
                      ? "first out of tolerance: " + *comparison.first_out_of_tolerance
                      : "all stages within tolerance");
  return lines;
}

std::optional<std::string> firstOut(const Comparison& comparison) {
  for (const StageComparison& stage : comparison.isolated) {
    if (!stage.within) return "isolated " + stage.stage;
  }
  for (const StageComparison& stage : comparison.chained) {
    if (!stage.within) return "chained " + stage.stage;
  }
  return std::nullopt;
}

DeviceWork workBetween(const DeviceWork& before, const DeviceWork& after) {
  return {after.draws - before.draws, after.launches - before.launches};
}

}  // namespace

Comparison comparePaths(const DepthImage& depth,
                        const std::optional<BinBox>& bin,
                        const ReferenceDatabase& database,
                        const EstimateOptions& options,
                        StageSet& reference,
                        StageSet& subject) {
  const auto run = [&](StageSet& stages) {
    Run result;
    const auto begin = std::chrono::steady_clock::now();
    result.estimate = estimatePoses(depth, bin, database, options, stages, &result.trace);
    const std::chrono::duration<double, std::milli> ms = std::chrono::steady_clock::now() - begin;
    result.ms = ms.count();
    return result;
  };
  Comparison comparison;
  comparison.reference = reference.name;
  comparison.subject = subject.name;
  comparison.left_to_host = subject.left_to_host;
  const DeviceWork before = subject.work();
  {
    const Run recorded = run(reference);
    comparison.isolated = compareIsolated(
        depth, bin, database, recorded.estimate, recorded.trace, reference, subject);
  }
  // By now both paths have made what they make once, so these times compare.
  const Run expected = run(reference);
  const Run actual = run(subject);
  comparison.chained = Chained(database, expected, actual, subject.name).results();
  comparison.first_out_of_tolerance = firstOut(comparison);
  comparison.verdict = verdictOf(comparison, database, expected, actual);
  comparison.subject_work = workBetween(before, subject.work());
  return comparison;
}

}  // namespace rangepose
