// The launch of a kernel: on the device, or on the emulated one.
#pragma once

#include <cuda_runtime.h>

#ifdef RP_CUDA_EMULATED
#include "cuda/emulated/launch.h"
#endif

namespace rangepose::cuda {

/// `kernel<<<blocks, threads, 0, stream>>>(arguments...)`. RP_LAUNCHED is to follow.
template <typename... Parameters, typename... Arguments>
void launch(void (*kernel)(Parameters...),
            dim3 blocks,
            dim3 threads,
            cudaStream_t stream,
            Arguments... arguments) {
#ifdef RP_CUDA_EMULATED
  emulated::queueLaunch(stream, blocks, threads, [=] { kernel(arguments...); });
#else
  // clang-format off
  kernel<<<blocks, threads, 0, stream>>>(arguments...);
  // clang-format on
#endif
}

}  // namespace rangepose::cuda
