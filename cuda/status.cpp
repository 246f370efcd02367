#include <cuda_runtime_api.h>

#include "cuda/check.h"
#include "cuda/cuda_path.h"

namespace rangepose::cuda {
namespace {

/// 13000 -> "13.0"
std::string versionText(int version) {
  return std::to_string(version / 1000) + "." + std::to_string(version % 1000 / 10);
}

constexpr int kLeastCapability = 75;

/// 75 -> "7.5"
std::string capabilityText(int capability) {
  return std::to_string(capability / 10) + "." + std::to_string(capability % 10);
}

std::string reasonOf(cudaError_t result) {
  return std::string(cudaGetErrorName(result)) + " (" + cudaGetErrorString(result) + ")";
}

DeviceInfo describe(int index) {
  DeviceInfo info;
  info.index = index;
  cudaDeviceProp properties{};
  if (cudaGetDeviceProperties(&properties, index) != cudaSuccess) return info;
  info.name = properties.name;
  info.capability = 10 * properties.major + properties.minor;
  info.multiprocessors = properties.multiProcessorCount;
  info.memory_mb = static_cast<double>(properties.totalGlobalMem) / 1.0e6;
  return info;
}

}  // namespace

Status status() {
  Status result;
  result.toolkit = versionText(CUDART_VERSION);
  result.emulated = kEmulated;
  int version = 0;
  if (cudaDriverGetVersion(&version) != cudaSuccess || version == 0) {
    result.missing = "no NVIDIA driver is found (libcuda.so.1); use --path auto, glsl or host";
    return result;
  }
  result.driver = versionText(version);
  int count = 0;
  const cudaError_t counted = cudaGetDeviceCount(&count);
  if (counted != cudaSuccess || count == 0) {
    result.missing = "no CUDA device is found: " +
                     (count == 0 && counted == cudaSuccess ? std::string("none is visible")
                                                           : reasonOf(counted)) +
                     "; look at nvidia-smi and CUDA_VISIBLE_DEVICES";
    static_cast<void>(cudaGetLastError());
    return result;
  }
  for (int index = 0; index < count; ++index) result.devices.push_back(describe(index));
  int current = 0;
  static_cast<void>(cudaGetDevice(&current));
  const DeviceInfo& device = result.devices.at(static_cast<std::size_t>(current));
  if (device.capability < kLeastCapability) {
    result.missing = "CUDA device " + std::to_string(current) + " (" + device.name +
                     ") is of compute capability " + capabilityText(device.capability) +
                     ", the kernels need " + capabilityText(kLeastCapability) +
                     "; choose another one by CUDA_VISIBLE_DEVICES";
  }
  return result;
}

}  // namespace rangepose::cuda
