// The CUDA path as the rest of the program sees it: whether it works here, and its stages. Needs no
// CUDA header; without a toolkit no_cuda.cpp answers.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "gles/context.h"
#include "stages/stage_set.h"

namespace rangepose::cuda {

/// How what GL renders reaches CUDA.
enum class Interop {
  kAuto,  ///< the first of the others that works
  kGles,  ///< textures of a GLES context, shared without a copy
  kGl,    ///< the same of a desktop GL 4.5 context, where the driver does not share those of GLES
  kCopy,  ///< read back into pinned host memory and copied to the device
};

/// "auto", "gles", "gl" or "copy"; anything else throws Error.
Interop parseInterop(std::string_view text);
const char* nameOf(Interop interop);

struct DeviceInfo {
  int index = 0;  ///< among the visible devices
  std::string name;
  int capability = 0;       ///< 10 * major + minor
  int multiprocessors = 0;  ///< SMs
  double memory_mb = 0.0;   ///< [MB]
};

/// What there is of CUDA here, for `rangepose doctor`.
struct Status {
  std::string toolkit;  ///< that it was built with, e.g. "13.0"; empty: built without CUDA
  std::string driver;   ///< newest CUDA that the driver knows, e.g. "13.0"; empty: no driver
  std::vector<DeviceInfo> devices;
  bool emulated = false;  ///< the device is one that the host emulates: for tests, never chosen
  std::string missing;    ///< one line that names what the path lacks; empty: it works
};
Status status();

struct PathOptions {
  Interop interop = Interop::kAuto;
  bool staged = false;  ///< the search as the paper's three programs instead of one kernel
};

/// The stages with what they need to live. The context draws surfaces; it outlives the stages.
struct Path {
  Path() = default;
  Path(Path&&) noexcept = default;
  /// Lets go of its stages before their context.
  Path& operator=(Path&& other) noexcept;

  std::unique_ptr<gles::Context> context;  ///< null: no GL here, the host draws
  std::unique_ptr<StageSet> stages;
  Interop interop = Interop::kAuto;  ///< what is in use, never kAuto
  std::string interop_note;          ///< one line: the renderer, and why others were passed over
};

/// A GLES context for rendering beside CUDA, on the same GPU if EGL has that. Throws Unavailable
/// where CUDA or GLES is missing.
std::unique_ptr<gles::Context> openContextOfDevice();

/// On the current CUDA device. Throws Unavailable, naming what is missing: the path was not built,
/// there is no driver or device, or the interop that was asked for does not work here.
Path openPath(const PathOptions& options = {});

}  // namespace rangepose::cuda
