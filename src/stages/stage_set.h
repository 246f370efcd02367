// A path (host, glsl, cuda): its stages, as four interfaces that hand images on where the path
// keeps them.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "stages/reference.h"
#include "stages/refine_tasks.h"
#include "stages/resident.h"
#include "stages/search.h"
#include "stages/stage_probe.h"

namespace rangepose {

class ForegroundStage {
 public:
  virtual ~ForegroundStage() = default;
  /// `keep` as in host::resample. Both must outlive the result.
  virtual std::unique_ptr<ResidentDepth> upload(const DepthImage& depth,
                                                const Image<std::uint8_t>& keep) = 0;
  /// Contract in foreground_host.h.
  virtual std::unique_ptr<ResidentForeground> find(const DepthImage& measured,
                                                   const ForegroundTask& task) = 0;
  /// Of all measured pixels that are kept.
  virtual LateralExtent extent(const ResidentDepth& depth) = 0;
};

/// A scene window to be made.
struct WindowTask {
  OrthoCamera camera;
  PixelBox region;  ///< of the depth pixels that are read; an empty box means all
};

using ResidentScenes = std::vector<std::unique_ptr<ResidentScene>>;

class SceneStage {
 public:
  virtual ~SceneStage() = default;
  /// Resampling, median, edges and distances of each, in order; contracts in resample_host.h and
  /// channels_host.h.
  virtual ResidentScenes prepare(const ResidentDepth& depth,
                                 const std::vector<WindowTask>& windows,
                                 const ChannelOptions& options) = 0;
  virtual std::unique_ptr<ResidentScene> upload(const SceneChannels& channels) = 0;
  /// host::patches.
  virtual Image<std::int32_t> patches(const ResidentScene& scene) = 0;
};

class SearchStage {
 public:
  virtual ~SearchStage() = default;
  /// One hypothesis a view and window, ordered by window, then view; seed_range_px[w] is the range
  /// at the centre of window w.
  virtual std::vector<Hypothesis> search(const ReferenceObject& object,
                                         const std::vector<const ResidentScene*>& windows,
                                         const std::vector<float>& seed_range_px,
                                         const SearchOptions& options) = 0;
};

/// One result a task, in order.
class RefineStage {
 public:
  virtual ~RefineStage() = default;
  virtual std::vector<IcpResult> align(const ResidentDepth& depth,
                                       const std::vector<AlignTask>& tasks) = 0;
  virtual std::vector<CheckResult> judge(const ResidentDepth& depth,
                                         const std::vector<JudgeTask>& tasks) = 0;
  virtual std::vector<IcpResult> alignSurfaces(const ResidentDepth& depth,
                                               const std::vector<RenderTask>& tasks) = 0;
  virtual std::vector<CheckResult> judgeSurfaces(const ResidentDepth& depth,
                                                 const std::vector<RenderTask>& tasks) = 0;
};

/// What a path has done on its device so far: proof for tests that the device did the work.
struct DeviceWork {
  std::int64_t draws = 0;     ///< GL draw calls
  std::int64_t launches = 0;  ///< CUDA kernels
};

/// Images and scenes go from stage to stage of one path only. For one thread at a time.
struct StageSet {
  std::string name;
  std::string
      left_to_host;  ///< what the path has no stage of its own for, in words; empty: nothing
  std::shared_ptr<ForegroundStage> foreground;
  std::shared_ptr<SceneStage> scenes;
  std::shared_ptr<SearchStage> search;
  std::shared_ptr<RefineStage> refine;
  std::shared_ptr<StageProbe> probe;
  std::function<DeviceWork()> work = [] { return DeviceWork{}; };
  PointsOfViews points_of_views;
};

/// Objects of which a path keeps what it made of them.
inline constexpr std::size_t kObjectsKept = 256;

/// The path whose parts `path` is: it lives as long as one of them is held.
template <typename Path>
std::unique_ptr<StageSet> stageSetOf(std::string name,
                                     std::string left_to_host,
                                     const std::shared_ptr<Path>& path) {
  const auto part = [&](auto& stage) {
    return std::shared_ptr<std::decay_t<decltype(stage)>>(path, &stage);
  };
  auto set = std::make_unique<StageSet>();
  set->name = std::move(name);
  set->left_to_host = std::move(left_to_host);
  set->foreground = part(path->foreground);
  set->scenes = part(path->scenes);
  set->search = part(path->search);
  set->refine = part(path->refine);
  set->probe = part(path->probe);
  return set;
}

/// The host path. Keeps a packed copy of the views of each object that it has searched.
std::unique_ptr<StageSet> makeHostStages();

}  // namespace rangepose
