// What the files of the emulated runtime share, and what tests ask it.
#pragma once

#include <cuda_runtime.h>

#include <cstddef>
#include <functional>
#include <optional>
#include <string>

namespace rangepose::cuda::emulated {

/// What was made and is not yet gone.
struct Alive {
  int allocations = 0;
  int pinned = 0;
  int arrays = 0;
  int textures = 0;  ///< texture and surface objects
  int streams = 0;
  int events = 0;
  int resources = 0;  ///< registered with GL

  int all() const {
    return allocations + pinned + arrays + textures + streams + events + resources;
  }
};
Alive alive();

/// The `nth` next call of the function, 1 the very next, fails with that error; once.
/// RP_CUDA_FAIL=cudaMalloc:3 in the environment does so from the start.
void failCall(const std::string& function, int nth, cudaError_t error);
void failNothing();

// What follows is for the runtime itself.

/// One call of the runtime at a time.
class Call {
 public:
  explicit Call(const char* function);
  ~Call();
  Call(const Call&) = delete;
  Call& operator=(const Call&) = delete;

  /// An error that was asked for: the call is to do nothing but give it.
  const std::optional<cudaError_t>& injected() const { return injected_; }

 private:
  std::optional<cudaError_t> injected_;
};

/// Remembers an error until somebody asks for the last one, and gives it.
cudaError_t remembered(cudaError_t error);

Alive& counts();

/// Puts work into a stream.
void queueWork(cudaStream_t stream, std::function<void()> work);
/// Does all work of a stream, or of all streams for nullopt; device memory can be read and written
/// meanwhile. Gives the error of the first work that failed since the last wait.
cudaError_t drain(std::optional<cudaStream_t> stream);

/// Device memory, in pages of its own behind which no others are: what reads or writes beyond it
/// ends the process, and so does the host wherever it touches it. Null where there is no more.
void* allocateDevice(std::size_t bytes);
void freeDevice(void* memory);
/// Opens device memory to the host while it lives.
class OpenMemory {
 public:
  OpenMemory();
  ~OpenMemory();
  OpenMemory(const OpenMemory&) = delete;
  OpenMemory& operator=(const OpenMemory&) = delete;
};

/// Elements of arrays and textures.
TexelKind kindOf(const cudaChannelFormatDesc& format);
std::size_t bytesOf(TexelKind kind);
cudaArray_t makeArray(TexelKind kind, int width, int height);
void dropArray(cudaArray_t array);
/// The texels of an array, row by row without gaps; device memory.
void* texelsOf(cudaArray_t array);

}  // namespace rangepose::cuda::emulated
