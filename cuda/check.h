// Checks of CUDA calls and of kernel launches.
#pragma once

#include <cuda_runtime_api.h>

#include <cstdint>

namespace rangepose::cuda {

/// Whether the device is one that the host emulates (cuda/emulated/README.md).
#ifdef RP_CUDA_EMULATED
inline constexpr bool kEmulated = true;
#else
inline constexpr bool kEmulated = false;
#endif

/// Kernels launched by this process so far.
std::int64_t launches();

namespace detail {
void checkCall(cudaError_t result, const char* call, const char* file, int line);
void checkLaunch(const char* kernel, const char* file, int line);
}  // namespace detail

}  // namespace rangepose::cuda

/// Throws Error with file, line, call and CUDA's message unless the call returns cudaSuccess.
#define RP_CUDA(call) ::rangepose::cuda::detail::checkCall((call), #call, __FILE__, __LINE__)

/// After each launch: throws Error when it failed. With RP_SYNC=1 in the environment it waits for
/// the kernel, so that an error inside of it names the right one.
#define RP_LAUNCHED(kernel) ::rangepose::cuda::detail::checkLaunch((kernel), __FILE__, __LINE__)
