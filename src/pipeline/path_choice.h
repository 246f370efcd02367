// Which path the stages take: what the user asked for, and what this machine has.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "cuda/cuda_path.h"
#include "gles/context.h"
#include "stages/stage_set.h"

namespace rangepose {

enum class PathRequest { kAuto, kHost, kGlsl, kCuda };

/// "auto", "host", "glsl" or "cuda"; anything else throws Error.
PathRequest parsePathRequest(std::string_view text);

/// The stages of a path with what they run on.
struct PathStages {
  PathStages() = default;
  PathStages(std::unique_ptr<gles::Context> its_context, std::unique_ptr<StageSet> its_stages)
      : context(std::move(its_context)), stages(std::move(its_stages)) {}
  PathStages(PathStages&&) noexcept = default;
  /// Lets go of its stages before their context.
  PathStages& operator=(PathStages&& other) noexcept {
    stages = std::move(other.stages);
    context = std::move(other.context);
    return *this;
  }

  std::unique_ptr<gles::Context> context;  ///< of the glsl and cuda paths; outlives the stages
  std::unique_ptr<StageSet> stages;
};

/// kAuto takes cuda where it works, else glsl on a hardware GPU, else host: on a software
/// rasteriser a full search in fragment shaders is 50 to 100 times slower than the host path.
/// Throws Unavailable when the path that was asked for does not work here.
PathStages openPath(PathRequest request, const cuda::PathOptions& cuda_options = {});

/// A context where this machine has one; null (kAuto only) or Unavailable where it has none. With
/// `hardware_only` kAuto passes over software rasterisers. kHost gives null; kCuda gives one only
/// where there is CUDA, on its device if that has one.
std::unique_ptr<gles::Context> openContext(PathRequest request, bool hardware_only);

}  // namespace rangepose
