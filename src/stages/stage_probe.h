// One stage of a path at a time, from and to host memory: for tests, benchmarks and `rangepose
// compare`, and what a trace holds beyond what the pipeline needs.
#pragma once

#include <cstdint>
#include <vector>

#include "stages/reference.h"
#include "stages/scene_channels.h"
#include "stages/search.h"
#include "stages/surface.h"

namespace rangepose {

/// Contracts in resample_host.h, channels_host.h, search_host.h and surface.h.
class StageProbe {
 public:
  virtual ~StageProbe() = default;
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
};

}  // namespace rangepose
