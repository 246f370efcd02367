#include "rangepose/cuda_options.h"

namespace rangepose::cli {

void declareInterop(CLI::App& command, CudaArguments& arguments) {
  command
      .add_option("--interop",
                  arguments.interop,
                  "How GL's images reach CUDA: shared by GLES, by desktop GL, or copied")
      ->check(CLI::IsMember({"auto", "gles", "gl", "copy"}))
      ->capture_default_str();
}

void declareCuda(CLI::App& command, CudaArguments& arguments) {
  declareInterop(command, arguments);
  command
      .add_option("--cuda-search",
                  arguments.search,
                  "One kernel, or the paper's three programs (slower, for comparison)")
      ->check(CLI::IsMember({"fused", "staged"}))
      ->capture_default_str();
}

cuda::PathOptions cudaOptions(const CudaArguments& arguments) {
  return {cuda::parseInterop(arguments.interop), arguments.search == "staged"};
}

}  // namespace rangepose::cli
