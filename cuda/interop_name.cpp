#include <string>
#include <utility>

#include "core/error.h"
#include "cuda/cuda_path.h"

namespace rangepose::cuda {

Interop parseInterop(std::string_view text) {
  for (const Interop interop : {Interop::kAuto, Interop::kGles, Interop::kGl, Interop::kCopy}) {
    if (text == nameOf(interop)) return interop;
  }
  throw Error("interop \"" + std::string(text) + "\" is unknown; use auto, gles, gl or copy");
}

const char* nameOf(Interop interop) {
  switch (interop) {
    case Interop::kAuto:
      return "auto";
    case Interop::kGles:
      return "gles";
    case Interop::kGl:
      return "gl";
    case Interop::kCopy:
      return "copy";
  }
  return "";
}

Path& Path::operator=(Path&& other) noexcept {
  stages = std::move(other.stages);
  context = std::move(other.context);
  interop = other.interop;
  interop_note = std::move(other.interop_note);
  return *this;
}

}  // namespace rangepose::cuda
