#include "pipeline/path_choice.h"

#include <string>
#include <utility>

#include "core/error.h"
#include "gles/stage_set_gles.h"

namespace rangepose {

PathRequest parsePathRequest(std::string_view text) {
  if (text == "auto") return PathRequest::kAuto;
  if (text == "host") return PathRequest::kHost;
  if (text == "glsl") return PathRequest::kGlsl;
  if (text == "cuda") return PathRequest::kCuda;
  throw Error("path \"" + std::string(text) + "\" is unknown; use auto, host, glsl or cuda");
}

std::unique_ptr<gles::Context> openContext(PathRequest request, bool hardware_only) {
  switch (request) {
    case PathRequest::kHost:
      return nullptr;
    case PathRequest::kCuda:
      return cuda::openContextOfDevice();
    case PathRequest::kGlsl:
      return std::make_unique<gles::Context>();
    case PathRequest::kAuto:
      break;
  }
  try {
    auto context = std::make_unique<gles::Context>();
    if (hardware_only && context->info().software) return nullptr;
    return context;
  } catch (const Unavailable&) {
    return nullptr;
  }
}

namespace {

PathStages openCuda(const cuda::PathOptions& options) {
  cuda::Path path = cuda::openPath(options);
  return {std::move(path.context), std::move(path.stages)};
}

}  // namespace

PathStages openPath(PathRequest request, const cuda::PathOptions& cuda_options) {
  if (request == PathRequest::kCuda) return openCuda(cuda_options);
  if (request == PathRequest::kAuto) {
    const cuda::Status cuda = cuda::status();
    if (cuda.missing.empty() && !cuda.emulated) return openCuda(cuda_options);
  }
  PathStages path;
  path.context = openContext(request, true);
  path.stages = path.context != nullptr ? gles::makeGlesStages(*path.context) : makeHostStages();
  return path;
}

}  // namespace rangepose
