// Kernels on the emulated device.
#pragma once

#include <cuda_runtime.h>

#include <functional>

namespace rangepose::cuda::emulated {

/// Puts the launch into the stream: it runs when something waits for it. `kernel` is called once
/// for each thread of each block.
void queueLaunch(cudaStream_t stream,
                 const dim3& blocks,
                 const dim3& threads,
                 std::function<void()> kernel);

/// Runs all blocks on all cores, those of a block as strands of one thread of the host: each runs
/// until a barrier, then the others do. Blocks, and threads between two barriers, run in an order
/// that the seed says (RP_CUDA_SHUFFLE in the environment; 0: as they are numbered).
/// Throws Error where a kernel does something that no device allows.
void runBlocks(const dim3& blocks, const dim3& threads, const std::function<void()>& kernel);

/// Of the launches from now on.
void setShuffle(unsigned seed);

/// Ends the launch with an error; for what kernels call.
[[noreturn]] void failKernel(const char* what);

}  // namespace rangepose::cuda::emulated
