// Options of the CUDA path, for the commands that may take it.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "cuda/cuda_path.h"

namespace rangepose::cli {

struct CudaArguments {
  std::string interop = "auto";
  std::string search = "fused";
};

/// --interop, --cuda-search.
void declareCuda(CLI::App& command, CudaArguments& arguments);
/// --interop alone.
void declareInterop(CLI::App& command, CudaArguments& arguments);

cuda::PathOptions cudaOptions(const CudaArguments& arguments);

}  // namespace rangepose::cli
