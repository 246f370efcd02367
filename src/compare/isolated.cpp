#include "compare/isolated.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "compare/refine_stages.h"
#include "compare/search_stages.h"
#include "compare/tally.h"
#include "pipeline/foreground_task.h"
#include "pipeline/scene_window.h"

namespace rangepose {
namespace {

class Isolated {
 public:
  Isolated(const DepthImage& depth,
           const EstimateTrace& trace,
           StageSet& reference,
           StageSet& subject)
      : depth_(depth),
        trace_(trace),
        reference_(reference),
        subject_(subject),
        search_(reference, subject) {}

  void foreground(const ForegroundTask& task) {
    const auto [expected, actual] = foreground_.run(reference_, subject_, [&](StageSet& stages) {
      return stages.foreground->find(depth_, task);
    });
    const Foreground& a = expected->on_host;
    const Foreground& b = actual->on_host;
    foreground_.addLabels(a.mask, b.mask);
    foreground_.addImages(a.depth.depth_mm, b.depth.depth_mm);
    background_.add(std::abs(a.noise_mm - b.noise_mm));
    for (std::size_t i = 0; i < std::min(a.background.size(), b.background.size()); ++i)
      background_.add(std::abs(a.background[i].offset_mm - b.background[i].offset_mm));
    background_.addMissing(surplus(a.background.size(), b.background.size()));
  }

  void compareObject(const ReferenceObject& object, const ObjectTrace& trace) {
    imageStages(trace.scene.camera, trace.scene_options);
    prepare(trace.scene.camera, {}, trace.scene_options);
    for (std::size_t i = 0; i < trace.windows.size(); ++i) {
      const OrthoCamera& camera = trace.windows[i].camera;
      imageStages(camera, channelOptionsOf(object));
      prepare(camera, trace.window_regions[i], channelOptionsOf(object));
    }
    if (!trace.windows.empty()) search_.compare(object, trace);
  }

  void surface(const ReferenceObject& object, const Pose& pose) {
    const int all = std::max(depth_.camera.width, depth_.camera.height);
    const SurfaceWindow window =
        windowAround(depth_.camera, pose * object.center_mm, object.radius_mm, all);
    if (window.width == 0) return;
    const auto [expected, actual] = outline_.run(reference_, subject_, [&](StageSet& stages) {
      return stages.probe->renderSurface(object.mesh, depth_.camera, pose, window);
    });
    if (actual.width() != expected.width() || actual.height() != expected.height()) {
      outline_.addMissing(static_cast<std::int64_t>(expected.size()));
      return;
    }
    for (std::size_t i = 0; i < expected.size(); ++i)
      surfacePixel(expected.data()[i], actual.data()[i]);
  }

  std::vector<StageComparison> results() const {
    std::vector<StageComparison> all;
    for (const Tally* tally : {&foreground_,
                               &background_,
                               &resample_,
                               &median_,
                               &edges_,
                               &edt_,
                               &distance_,
                               &patches_,
                               &prepare_}) {
      all.push_back(tally->result());
    }
    for (const StageComparison& result : search_.results()) all.push_back(result);
    for (const Tally* tally : {&outline_, &surface_depth_, &normals_})
      all.push_back(tally->result());
    return all;
  }

 private:
  void imageStages(const OrthoCamera& camera, const ChannelOptions& options) {
    const auto [raw, raw_actual] = resample_.run(reference_, subject_, [&](StageSet& stages) {
      return stages.probe->resample(depth_, trace_.foreground, camera);
    });
    resample_.addImages(raw, raw_actual);
    const auto [range, range_actual] = median_.run(
        reference_, subject_, [&raw = raw](StageSet& stages) { return stages.probe->median(raw); });
    median_.addImages(range, range_actual);
    channelStages(range, options);
  }

  void channelStages(const Image<float>& range, const ChannelOptions& options) {
    const auto [edges, edges_actual] = edges_.run(reference_, subject_, [&](StageSet& stages) {
      return stages.probe->edges(range, options.edgeThresholdPx());
    });
    edges_.addImages(edges, edges_actual);
    const auto [texels, texels_actual] =
        edt_.run(reference_, subject_, [&, &marks = edges](StageSet& stages) {
          return stages.probe->distanceTexels(range, marks, options.edt_passes);
        });
    edt_.addImages(texels, texels_actual, [](const EdtTexel& a, const EdtTexel& b) {
      return static_cast<double>(
          std::max(std::max(std::abs(a.site_x - b.site_x), std::abs(a.site_y - b.site_y)),
                   std::max(std::abs(a.signed_sq - b.signed_sq), std::abs(a.found - b.found))));
    });
    const auto [distance, distance_actual] =
        distance_.run(reference_, subject_, [&, &marks = edges](StageSet& stages) {
          return stages.probe->distance(range, marks, options.edt_passes);
        });
    distance_.addImages(distance, distance_actual);
    const auto [labels, labels_actual] =
        patches_.run(reference_, subject_, [&, &marks = edges](StageSet& stages) {
          return stages.probe->patches(range, marks);
        });
    patches_.addLabels(labels, labels_actual);
  }

  void prepare(const OrthoCamera& camera, const PixelBox& region, const ChannelOptions& options) {
    const auto [expected, actual] = prepare_.run(reference_, subject_, [&](StageSet& stages) {
      const auto resident = stages.foreground->upload(depth_, trace_.foreground);
      return stages.scenes->prepare(*resident, {{camera, region}}, options).front()->download();
    });
    prepare_.addImages(expected.range_px, actual.range_px);
    prepare_.addImages(expected.edges, actual.edges);
    prepare_.addImages(expected.distance_px, actual.distance_px);
  }

  void surfacePixel(const SurfaceTexel& a, const SurfaceTexel& b) {
    if (a.w == 0.0f && b.w == 0.0f) return;
    const bool both = a.w != 0.0f && b.w != 0.0f;
    outline_.add(both ? 0.0 : 1.0);
    if (!both) return;
    surface_depth_.add(std::abs(static_cast<double>(a.w) - static_cast<double>(b.w)));
    const glm::vec3 gap = glm::abs(glm::vec3(a) - glm::vec3(b));
    normals_.add(static_cast<double>(std::max({gap.x, gap.y, gap.z})));
  }

  const DepthImage& depth_;
  const EstimateTrace& trace_;
  StageSet& reference_;
  StageSet& subject_;
  SearchComparison search_;
  Tally foreground_{"foreground", subject_.name};
  Tally background_{"background", subject_.name};
  Tally resample_{"resample", subject_.name};
  Tally median_{"median", subject_.name};
  Tally edges_{"edges", subject_.name};
  Tally edt_{"edt", subject_.name};
  Tally distance_{"distance", subject_.name};
  Tally patches_{"patches", subject_.name};
  Tally prepare_{"prepare", subject_.name};
  Tally outline_{"surface outline", subject_.name};
  Tally surface_depth_{"surface depth", subject_.name};
  Tally normals_{"surface normals", subject_.name};
};

/// The pose of the best hypothesis, for an image in which none was good enough to be reported.
std::optional<Pose> roughPose(const ReferenceObject& object, const ObjectTrace& trace) {
  const Hypothesis* best = lowestError(trace);
  if (best == nullptr) return std::nullopt;
  return poseOf(*best, object, trace.windows[static_cast<std::size_t>(best->window)].camera);
}

}  // namespace

std::vector<StageComparison> compareIsolated(const DepthImage& depth,
                                             const std::optional<BinBox>& bin,
                                             const ReferenceDatabase& database,
                                             const Estimate& estimate,
                                             const EstimateTrace& trace,
                                             StageSet& reference,
                                             StageSet& subject) {
  Isolated isolated(depth, trace, reference, subject);
  isolated.foreground(foregroundTaskFor(database, bin));
  for (std::size_t i = 0; i < trace.objects.size(); ++i) {
    const ReferenceObject& object = database.objects[i];
    if (trace.objects[i].scene.range_px.empty()) continue;  // nothing stands out of the background
    isolated.compareObject(object, trace.objects[i]);
    if (!estimate.poses.empty()) continue;
    if (const std::optional<Pose> rough = roughPose(object, trace.objects[i])) {
      isolated.surface(object, *rough);
    }
  }
  for (const PoseEstimate& found : estimate.poses) {
    isolated.surface(database.objects[static_cast<std::size_t>(found.object)], found.pose);
  }
  std::vector<StageComparison> all = isolated.results();
  for (const StageComparison& stage :
       compareRefinement(depth, database, estimate, trace, reference, subject)) {
    all.push_back(stage);
  }
  return all;
}

}  // namespace rangepose
