// All stages on one path (host, glsl, cuda), behind one interface.
//
// Two ways to call them: one stage at a time with images in host memory (tests, `rangepose
// compare`), or chained with the images kept where the path keeps them (`prepare`, `search`: the
// pipeline).
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "stages/check_host.h"
#include "stages/foreground.h"
#include "stages/icp_host.h"
#include "stages/reference.h"
#include "stages/scene_channels.h"
#include "stages/search.h"
#include "stages/surface.h"
#include "stages/surface_points.h"

namespace rangepose {

/// What a path has done on its device so far: proof for tests that the device did the work.
struct DeviceWork {
  std::int64_t draws = 0;     ///< GL draw calls
  std::int64_t launches = 0;  ///< CUDA kernels
};

/// Scene channels where the path keeps them.
class ResidentScene {
 public:
  virtual ~ResidentScene() = default;
  virtual const OrthoCamera& camera() const = 0;
  /// A copy in host memory.
  virtual SceneChannels download() const = 0;
};

using ViewPoints = std::vector<std::vector<SurfacePoint>>;  ///< by view

/// A depth image, and what of it is not background, where the path keeps them.
class ResidentDepth {
 public:
  virtual ~ResidentDepth() = default;
};

/// A foreground, with its depth image and mask also where the path keeps them: `resident` may refer
/// to `on_host`, so it stays where it is.
struct ResidentForeground {
  ResidentForeground() = default;
  ResidentForeground(const ResidentForeground&) = delete;
  ResidentForeground& operator=(const ResidentForeground&) = delete;

  Foreground on_host;
  std::unique_ptr<ResidentDepth> resident;
};

/// A pose to be aligned with the depth image without background; contract in icp_host.h.
struct AlignTask {
  const std::vector<SurfacePoint>* points = nullptr;
  Pose start;  ///< camera_from_object
  glm::dvec3 center_mm{0.0};
  double radius_mm = 0.0;
  IcpOptions options;
  /// The points are of pointsOfViews() and stay as they are: a path may keep a copy on its device.
  bool kept = false;
};

/// Points of a posed object to be judged by the whole depth image; contract in check_host.h.
struct JudgeTask {
  const std::vector<SurfacePoint>* points = nullptr;
  Pose camera_from_object;
  double visible_mm2 = 0.0;  ///< area that the points stand for [mm^2]
  CheckOptions options;
  bool kept = false;  ///< see AlignTask
};

/// A posed object whose rendered surface is aligned with the depth image without background, or
/// judged by the whole of it. Fields of the other use are ignored.
struct RenderTask {
  const Mesh* mesh = nullptr;
  Pose camera_from_object;
  SurfaceWindow window;       ///< of the rendering; of the depth image's camera
  int max_points = 0;         ///< alignment: >= 1, as in pointsOfSurface and rimOfSurface
  glm::dvec3 center_mm{0.0};  ///< of the sphere around the object, in its frame
  double radius_mm = 0.0;     ///< of that sphere
  IcpOptions alignment;
  CheckOptions check;
  /// That sphere in the camera frame.
  Sphere sphere() const { return {camera_from_object * center_mm, radius_mm}; }
};

/// A scene window to be prepared; see StageSet::prepare.
struct WindowTask {
  OrthoCamera camera;
  PixelBox region;
};

class StageSet {
 public:
  virtual ~StageSet() = default;
  virtual std::string name() const = 0;
  virtual DeviceWork work() const { return {}; }
  /// Whether several threads may call it at the same time (a GL context belongs to one thread).
  virtual bool concurrent() const { return false; }

  // One stage at a time; contracts in channels_host.h, resample_host.h, surface.h.
  virtual Image<float> resample(const DepthImage& image,
                                const Image<std::uint8_t>& keep,
                                const OrthoCamera& camera) = 0;
  virtual Image<float> median(const Image<float>& range) = 0;
  virtual Image<float> edges(const Image<float>& range_px, float threshold_px) = 0;
  virtual Image<EdtTexel> distanceTexels(const Image<float>& range_px,
                                         const Image<float>& edges,
                                         int passes) = 0;
  virtual Image<float> distance(const Image<float>& range_px,
                                const Image<float>& edges,
                                int passes) = 0;
  virtual Image<std::int32_t> patches(const Image<float>& range_px, const Image<float>& edges) = 0;
  virtual std::vector<ErrorTerms> errorTerms(const ReferenceObject& object,
                                             const SceneChannels& window,
                                             const std::vector<glm::vec3>& translations_px,
                                             const ErrorOptions& options) = 0;
  /// One step of many simplexes; values[i] belongs to states[i].candidate.
  virtual std::vector<SimplexState> simplexSteps(const std::vector<SimplexState>& states,
                                                 const std::vector<float>& values,
                                                 const SimplexOptions& options) = 0;
  virtual Image<SurfaceTexel> renderSurface(const Mesh& mesh,
                                            const Camera& camera,
                                            const Pose& camera_from_object,
                                            const SurfaceWindow& window) = 0;

  // Chained. `region` limits the depth pixels that are read; an empty box means all.
  virtual std::unique_ptr<ResidentScene> prepare(const DepthImage& image,
                                                 const Image<std::uint8_t>& keep,
                                                 const OrthoCamera& camera,
                                                 const PixelBox& region,
                                                 const ChannelOptions& options) = 0;
  virtual std::unique_ptr<ResidentScene> upload(const SceneChannels& channels) = 0;
  virtual Image<std::int32_t> patches(const ResidentScene& scene) = 0;
  /// Windows come from `prepare` or `upload` of the same path. One hypothesis a view and window,
  /// ordered by window, then view; seed_range_px[w] is the range at the centre of window w.
  virtual std::vector<Hypothesis> search(const ReferenceObject& object,
                                         const std::vector<const ResidentScene*>& windows,
                                         const std::vector<float>& seed_range_px,
                                         const SearchOptions& options) = 0;

  // A depth image that is used more than once, and the refinement of many poses on it. What is not
  // overridden runs on the host.
  /// `keep` as in `resample`. Both must outlive the result.
  virtual std::unique_ptr<ResidentDepth> uploadDepth(const DepthImage& depth,
                                                     const Image<std::uint8_t>& keep);
  /// Contract in foreground_host.h.
  virtual std::unique_ptr<ResidentForeground> foreground(const DepthImage& measured,
                                                         const ForegroundTask& task);
  /// Of all measured pixels that are kept.
  virtual LateralExtent extent(const ResidentDepth& depth);
  /// As `prepare` of the same image and mask.
  virtual std::unique_ptr<ResidentScene> prepare(const ResidentDepth& depth,
                                                 const OrthoCamera& camera,
                                                 const PixelBox& region,
                                                 const ChannelOptions& options);
  /// `prepare` of each, in order.
  std::vector<std::unique_ptr<ResidentScene>> prepareEach(const ResidentDepth& depth,
                                                          const std::vector<WindowTask>& windows,
                                                          const ChannelOptions& options);
  /// One result a task, in order. `depth` comes from the same path.
  virtual std::vector<IcpResult> align(const ResidentDepth& depth,
                                       const std::vector<AlignTask>& tasks);
  virtual std::vector<CheckResult> judge(const ResidentDepth& depth,
                                         const std::vector<JudgeTask>& tasks);
  virtual std::vector<IcpResult> alignSurfaces(const ResidentDepth& depth,
                                               const std::vector<RenderTask>& tasks);
  virtual std::vector<CheckResult> judgeSurfaces(const ResidentDepth& depth,
                                                 const std::vector<RenderTask>& tasks);

  /// pointsAndRimOfView of an object's views, of those asked for at least. Made once: they are the
  /// same in every image. Valid as long as this.
  const ViewPoints& pointsOfViews(const ReferenceObject& object,
                                  int max_points,
                                  std::vector<int> views);

 private:
  /// By ReferenceObject::serial and number of points.
  std::map<std::pair<std::uint64_t, int>, ViewPoints> points_of_views_;
};

/// The host path. Keeps a packed copy of the views of each object that it has searched.
std::unique_ptr<StageSet> makeHostStages();

}  // namespace rangepose
