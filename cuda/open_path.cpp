// Which GL context the CUDA path draws with, and how its images reach CUDA: tried, not assumed.
#include <cstdlib>
#include <string>
#include <utility>

#include "core/error.h"
#include "cuda/check.h"
#include "cuda/cuda_path.h"
#include "cuda/shared_texture.h"
#include "cuda/stage_set_cuda.h"

namespace rangepose::cuda {
namespace {

void requireDevice() {
  const std::string missing = status().missing;
  if (!missing.empty()) throw Unavailable("path cuda: " + missing);
}

/// The number that EGL_CUDA_DEVICE_NV gives the current device. EGL numbers all devices of the
/// machine, CUDA those that CUDA_VISIBLE_DEVICES leaves; -1 where that names them by something else
/// than numbers. It only says what to try first.
int eglNumberOfDevice() {
  int current = 0;
  RP_CUDA(cudaGetDevice(&current));
  const char* visible = std::getenv("CUDA_VISIBLE_DEVICES");
  if (visible == nullptr || *visible == '\0') return current;
  const char* at = visible;
  for (int skip = 0; *at != '\0'; ++skip) {
    char* end = nullptr;
    const long number = std::strtol(at, &end, 10);
    if (end == at) return -1;
    if (skip == current) return static_cast<int>(number);
    at = *end == ',' ? end + 1 : end;
    if (*end != ',' && *end != '\0') return -1;
  }
  return -1;
}

gles::ContextOptions contextOptions(gles::Api api) {
  gles::ContextOptions options;
  options.cuda_device = eglNumberOfDevice();
  options.api = api;
  return options;
}

/// The first context whose textures CUDA shares in truth. Throws Unavailable with what each said.
std::unique_ptr<gles::Context> openSharing(Interop interop) {
  const gles::ContextOptions options =
      contextOptions(interop == Interop::kGl ? gles::Api::kDesktop : gles::Api::kGles);
  std::string reasons;
  for (const gles::DisplaySource& source : gles::displaySources(options.cuda_device)) {
    if (source.software && !kEmulated) continue;
    std::string reason;
    try {
      auto context = std::make_unique<gles::Context>(source, options);
      if (context->info().software && !kEmulated) {
        throw Unavailable("only software GL (" + context->info().renderer + ")");
      }
      requireSharing();
      context->checkGl("a texture shared with CUDA");
      return context;
    } catch (const Error& error) {
      reason = error.what();
    }
    if (reason.rfind(source.name, 0) != 0) reason.insert(0, source.name + ": ");
    if (!reasons.empty()) reasons += "; ";
    reasons += reason;
  }
  throw Unavailable("interop " + std::string(nameOf(interop)) + ": " +
                    (reasons.empty() ? "EGL has no hardware device" : reasons));
}

/// For drawing without sharing: null where there is no hardware GL, the host draws faster than
/// software GL.
std::unique_ptr<gles::Context> openDrawing(std::string& note) {
  try {
    auto context = std::make_unique<gles::Context>(contextOptions(gles::Api::kGles));
    if (!context->info().software || kEmulated) return context;
    note += "; GL is only in software (" + context->info().renderer + "), the host draws";
  } catch (const Error& error) {
    note += "; the host draws: " + std::string(error.what());
  }
  return nullptr;
}

Path openCopying(std::string note) {
  Path path;
  path.interop = Interop::kCopy;
  path.context = openDrawing(note);
  path.interop_note = "copies through pinned memory" + note;
  return path;
}

Path openSharingPath(Interop interop) {
  Path path;
  path.interop = interop;
  path.context = openSharing(interop);
  path.interop_note = "textures of " + path.context->info().renderer + " (" +
                      path.context->info().version + ") are shared";
  return path;
}

/// GLES, then desktop GL, then copies.
Path openAny() {
  std::string note;
  for (const Interop interop : {Interop::kGles, Interop::kGl}) {
    try {
      Path path = openSharingPath(interop);
      path.interop_note += note;
      return path;
    } catch (const Unavailable& error) {
      note += "; not " + std::string(error.what());
    }
  }
  return openCopying(note);
}

Path openInterop(Interop interop) {
  if (interop == Interop::kAuto) return openAny();
  if (interop == Interop::kCopy) return openCopying("");
  return openSharingPath(interop);
}

}  // namespace

std::unique_ptr<gles::Context> openContextOfDevice() {
  requireDevice();
  return std::make_unique<gles::Context>(contextOptions(gles::Api::kGles));
}

Path openPath(const PathOptions& options) {
  requireDevice();
  Path path = openInterop(options.interop);
  path.stages = makeCudaStages(path.context.get(), path.interop != Interop::kCopy, options.staged);
  return path;
}

}  // namespace rangepose::cuda
