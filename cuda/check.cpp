#include "cuda/check.h"

#include <atomic>
#include <cstdlib>
#include <cstring>
#include <string>

#include "core/error.h"

namespace rangepose::cuda {
namespace {

std::atomic<std::int64_t> launched{0};

bool waitsForKernels() {
  static const bool kWaits = [] {
    const char* value = std::getenv("RP_SYNC");
    return value != nullptr && std::strcmp(value, "1") == 0;
  }();
  return kWaits;
}

/// "search_fused.cu:87": the folder is that of the machine it was built on.
std::string place(const char* file, int line) {
  const char* slash = std::strrchr(file, '/');
  return std::string(slash == nullptr ? file : slash + 1) + ":" + std::to_string(line);
}

[[noreturn]] void fail(cudaError_t result, const std::string& what, const char* file, int line) {
  // A failed call is also remembered as the last error; the next launch must not report it again.
  static_cast<void>(cudaGetLastError());
  throw Error(place(file, line) + ": " + what + ": " + cudaGetErrorName(result) + " (" +
              cudaGetErrorString(result) + ")");
}

}  // namespace

std::int64_t launches() { return launched.load(); }

namespace detail {

void checkCall(cudaError_t result, const char* call, const char* file, int line) {
  if (result != cudaSuccess) fail(result, call, file, line);
}

void checkLaunch(const char* kernel, const char* file, int line) {
  ++launched;
  cudaError_t result = cudaGetLastError();
  if (result == cudaSuccess && waitsForKernels()) result = cudaDeviceSynchronize();
  if (result != cudaSuccess) fail(result, std::string("kernel ") + kernel, file, line);
}

}  // namespace detail
}  // namespace rangepose::cuda
