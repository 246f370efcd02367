#include "rangepose/compare_picture.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "debug/canvas.h"
#include "debug/compare_pictures.h"

namespace rangepose::cli {
namespace {

using debug::ComparedStage;
using Kind = ComparedStage::Kind;

Image<float> surfaceOf(StageSet& stages,
                       const DepthImage& depth,
                       const ReferenceDatabase& database,
                       const Estimate& estimate) {
  if (estimate.poses.empty()) return {};
  const PoseEstimate& best = estimate.poses.front();
  const ReferenceObject& object = database.objects[static_cast<std::size_t>(best.object)];
  const int all = std::max(depth.camera.width, depth.camera.height);
  const SurfaceWindow window =
      windowAround(depth.camera, best.pose * object.center_mm, object.radius_mm, all);
  const Image<SurfaceTexel> surface =
      stages.probe->renderSurface(object.mesh, depth.camera, best.pose, window);
  Image<float> depth_mm(surface.width(), surface.height());
  std::transform(surface.begin(), surface.end(), depth_mm.begin(), [](const SurfaceTexel& texel) {
    return texel.w;
  });
  return depth_mm;
}

/// Labels of pixels as numbers that a float holds exactly: images are smaller than 2^24 pixels.
Image<float> floats(const Image<std::int32_t>& labels) {
  Image<float> result(labels.width(), labels.height());
  std::transform(labels.begin(), labels.end(), result.begin(), [](std::int32_t label) {
    return static_cast<float>(label);
  });
  return result;
}

/// The errors of all views in one window, view after view in rows.
Image<float> errorsOf(const std::vector<Hypothesis>& hypotheses, int window) {
  std::vector<float> errors;
  for (const Hypothesis& hypothesis : hypotheses) {
    if (hypothesis.window == window) errors.push_back(hypothesis.error);
  }
  if (errors.empty()) return {};
  constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
  const int columns = static_cast<int>(std::ceil(std::sqrt(static_cast<double>(errors.size()))));
  const int rows = (static_cast<int>(errors.size()) + columns - 1) / columns;
  Image<float> image(columns, rows, kNone);
  std::transform(errors.begin(), errors.end(), image.begin(), [](float error) {
    return error < kWorstError ? error : kNone;
  });
  return image;
}

class Rows {
 public:
  explicit Rows(const std::vector<SeenPath>& paths) : paths_(paths) {}

  /// `image(trace)` of the first object on each path; no row where the reference has none.
  template <typename ImageOf>
  void add(const std::string& name, const std::string& unit, Kind kind, const ImageOf& image) {
    ComparedStage stage{name, unit, kind, {}};
    for (const SeenPath& path : paths_) {
      stage.images.push_back(path.trace.objects.empty() ? Image<float>()
                                                        : image(path.trace.objects.front()));
    }
    push(std::move(stage));
  }
  void addSurfaces() {
    ComparedStage stage{"rendered surface", "mm", Kind::kPositive, {}};
    for (const SeenPath& path : paths_) stage.images.push_back(path.surface_mm);
    push(std::move(stage));
  }
  void addWindow(std::size_t index) {
    const std::string name = "window " + std::to_string(index + 1);
    const auto window = [index](const ObjectTrace& trace) {
      return index < trace.windows.size() ? trace.windows[index] : SceneChannels();
    };
    add(name + " range", "px", Kind::kPositive, [&](const ObjectTrace& trace) {
      return window(trace).range_px;
    });
    add(name + " distance", "px", Kind::kSigned, [&](const ObjectTrace& trace) {
      return window(trace).distance_px;
    });
    add(name + " error of each view", "", Kind::kPositive, [&](const ObjectTrace& trace) {
      return errorsOf(trace.hypotheses, static_cast<int>(index));
    });
  }
  const std::vector<ComparedStage>& stages() const { return stages_; }

 private:
  void push(ComparedStage stage) {
    if (!stage.images.front().empty()) stages_.push_back(std::move(stage));
  }
  const std::vector<SeenPath>& paths_;
  std::vector<ComparedStage> stages_;
};

}  // namespace

SeenPath seeOnPath(StageSet& stages,
                   const DepthImage& depth,
                   const std::optional<BinBox>& bin,
                   const ReferenceDatabase& database,
                   const EstimateOptions& options,
                   const SeenPath* reference) {
  SeenPath seen;
  seen.path = stages.name;
  seen.estimate = estimatePoses(depth, bin, database, options, stages, &seen.trace);
  const Estimate& rendered = reference != nullptr ? reference->estimate : seen.estimate;
  seen.surface_mm = surfaceOf(stages, depth, database, rendered);
  return seen;
}

void writeComparison(const std::filesystem::path& file, const std::vector<SeenPath>& paths) {
  Rows rows(paths);
  const auto scene = [](const auto& channel) {
    return [channel](const ObjectTrace& trace) { return trace.scene.*channel; };
  };
  rows.add("range before the median", "px", Kind::kPositive, [](const ObjectTrace& trace) {
    return trace.raw_range_px;
  });
  rows.add("range", "px", Kind::kPositive, scene(&SceneChannels::range_px));
  rows.add("edges", "", Kind::kPositive, scene(&SceneChannels::edges));
  rows.add("distance", "px", Kind::kSigned, scene(&SceneChannels::distance_px));
  rows.add(
      "patches", "", Kind::kLabels, [](const ObjectTrace& trace) { return floats(trace.labels); });
  const EstimateTrace& reference = paths.front().trace;
  const std::size_t windows =
      reference.objects.empty() ? 0 : reference.objects.front().windows.size();
  for (std::size_t i = 0; i < windows; ++i) rows.addWindow(i);
  rows.addSurfaces();
  std::vector<std::string> names;
  for (const SeenPath& path : paths) names.push_back(path.path);
  debug::writePng(file, debug::comparisonPicture(names, rows.stages()));
}

}  // namespace rangepose::cli
