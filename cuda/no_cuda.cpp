// The CUDA path of a program that was built without a toolkit.
#include "core/error.h"
#include "cuda/cuda_path.h"

namespace rangepose::cuda {

Status status() {
  Status result;
  result.missing =
      "this program was built without CUDA; build it where nvcc is found (CUDACXX), or use --path "
      "auto, glsl or host";
  return result;
}

std::unique_ptr<gles::Context> openContextOfDevice() {
  throw Unavailable("path cuda: " + status().missing);
}

Path openPath(const PathOptions&) { throw Unavailable("path cuda: " + status().missing); }

}  // namespace rangepose::cuda
