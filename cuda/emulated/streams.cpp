// Streams, events, errors and the one device of the emulated runtime.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <map>
#include <mutex>
#include <set>
#include <utility>

#include "core/error.h"
#include "cuda/emulated/launch.h"
#include "cuda/emulated/runtime.h"

struct CUevent_st {
  bool recorded = false;
  bool reached = false;
  CUstream_st* stream = nullptr;
  std::chrono::steady_clock::time_point when;
};

struct CUstream_st {
  std::deque<std::function<void()>> work;
};

namespace rangepose::cuda::emulated {
namespace {

using Clock = std::chrono::steady_clock;

std::recursive_mutex& oneAtATime() {
  static auto* const mutex = new std::recursive_mutex();
  return *mutex;
}

/// What the whole process shares; never destroyed, since others may go after it.
struct Device {
  CUstream_st first;  ///< the default stream
  std::set<CUstream_st*> streams{&first};
  std::set<CUevent_st*> events;
  Alive alive;
  std::string failure;  ///< of a kernel or a copy, until a wait tells it
  std::string told;     ///< of those that were told, the last
  struct Planned {
    int nth;
    cudaError_t error;
  };
  std::map<std::string, Planned> planned;
};

/// RP_CUDA_FAIL=function:nth
void planFromEnvironment(Device& device) {
  const char* text = std::getenv("RP_CUDA_FAIL");
  const char* colon = text == nullptr ? nullptr : std::strchr(text, ':');
  if (colon == nullptr) return;
  device.planned[std::string(text, colon)] = {std::atoi(colon + 1), cudaErrorUnknown};
}

Device& device() {
  static Device* const it = [] {
    auto* made = new Device();
    planFromEnvironment(*made);
    std::atexit([] {
      const int left = device().alive.all();
      if (left > 0)
        std::fprintf(stderr, "emulated CUDA device: %d things were never freed\n", left);
    });
    return made;
  }();
  return *it;
}

thread_local cudaError_t last_error = cudaSuccess;

CUstream_st& streamOf(cudaStream_t stream) { return stream == nullptr ? device().first : *stream; }

void drainOne(CUstream_st& stream) {
  while (!stream.work.empty()) {
    const std::function<void()> work = std::move(stream.work.front());
    stream.work.pop_front();
    try {
      work();
    } catch (const Error& error) {
      if (device().failure.empty()) device().failure = error.what();
    }
  }
}

}  // namespace

Alive alive() {
  const std::lock_guard lock(oneAtATime());
  return device().alive;
}

Alive& counts() { return device().alive; }

void failCall(const std::string& function, int nth, cudaError_t error) {
  const std::lock_guard lock(oneAtATime());
  device().planned[function] = {nth, error};
}

void failNothing() {
  const std::lock_guard lock(oneAtATime());
  device().planned.clear();
}

Call::Call(const char* function) {
  oneAtATime().lock();
  auto& planned = device().planned;
  const auto found = planned.find(function);
  if (found == planned.end() || --found->second.nth > 0) return;
  injected_ = found->second.error;
  planned.erase(found);
}

Call::~Call() { oneAtATime().unlock(); }

cudaError_t remembered(cudaError_t error) {
  if (error != cudaSuccess) last_error = error;
  return error;
}

void queueWork(cudaStream_t stream, std::function<void()> work) {
  const std::lock_guard lock(oneAtATime());
  streamOf(stream).work.push_back(std::move(work));
}

void queueLaunch(cudaStream_t stream,
                 const dim3& blocks,
                 const dim3& threads,
                 std::function<void()> kernel) {
  const Call call("kernel");
  const auto volume = [](const dim3& size) {
    return static_cast<unsigned long long>(size.x) * size.y * size.z;
  };
  // Limits of every device since compute capability 3.0.
  const bool possible = volume(blocks) > 0 && volume(threads) > 0 && volume(threads) <= 1024 &&
                        threads.z <= 64 && blocks.x < 0x80000000U && blocks.y <= 65535 &&
                        blocks.z <= 65535 && device().streams.contains(&streamOf(stream));
  if (call.injected() || !possible) {
    remembered(call.injected().value_or(cudaErrorInvalidConfiguration));
    return;
  }
  queueWork(stream,
            [blocks, threads, run = std::move(kernel)] { runBlocks(blocks, threads, run); });
}

cudaError_t drain(std::optional<cudaStream_t> stream) {
  const std::lock_guard lock(oneAtATime());
  {
    const OpenMemory open;
    if (stream) {
      drainOne(streamOf(*stream));
    } else {
      for (CUstream_st* one : device().streams) drainOne(*one);
    }
  }
  if (device().failure.empty()) return cudaSuccess;
  device().told = std::exchange(device().failure, {});
  return cudaErrorLaunchFailure;
}

}  // namespace rangepose::cuda::emulated

using namespace rangepose::cuda::emulated;

cudaError_t cudaGetDeviceCount(int* count) {
  const Call call("cudaGetDeviceCount");
  if (call.injected()) return remembered(*call.injected());
  *count = 1;
  return cudaSuccess;
}

cudaError_t cudaGetDevice(int* number) {
  const Call call("cudaGetDevice");
  if (call.injected()) return remembered(*call.injected());
  *number = 0;
  return cudaSuccess;
}

cudaError_t cudaGetDeviceProperties(cudaDeviceProp* properties, int /*device*/) {
  const Call call("cudaGetDeviceProperties");
  if (call.injected()) return remembered(*call.injected());
  *properties = {};
  std::strncpy(properties->name, "emulated on the host", sizeof properties->name - 1);
  properties->totalGlobalMem = std::size_t{8} << 30U;
  properties->major = 7;
  properties->minor = 5;
  properties->multiProcessorCount = 1;
  return cudaSuccess;
}

cudaError_t cudaDriverGetVersion(int* version) {
  *version = CUDART_VERSION;
  return cudaSuccess;
}

cudaError_t cudaGetLastError() { return std::exchange(last_error, cudaSuccess); }

const char* cudaGetErrorName(cudaError_t error) {
  switch (error) {
    case cudaSuccess:
      return "cudaSuccess";
    case cudaErrorInvalidValue:
      return "cudaErrorInvalidValue";
    case cudaErrorMemoryAllocation:
      return "cudaErrorMemoryAllocation";
    case cudaErrorInvalidConfiguration:
      return "cudaErrorInvalidConfiguration";
    case cudaErrorInvalidDevicePointer:
      return "cudaErrorInvalidDevicePointer";
    case cudaErrorInvalidChannelDescriptor:
      return "cudaErrorInvalidChannelDescriptor";
    case cudaErrorInvalidMemcpyDirection:
      return "cudaErrorInvalidMemcpyDirection";
    case cudaErrorNoDevice:
      return "cudaErrorNoDevice";
    case cudaErrorInvalidGraphicsContext:
      return "cudaErrorInvalidGraphicsContext";
    case cudaErrorInvalidResourceHandle:
      return "cudaErrorInvalidResourceHandle";
    case cudaErrorLaunchFailure:
      return "cudaErrorLaunchFailure";
    case cudaErrorUnknown:
      return "cudaErrorUnknown";
  }
  return "unrecognized error code";
}

const char* cudaGetErrorString(cudaError_t error) {
  if (error == cudaSuccess) return "no error";
  if (error != cudaErrorLaunchFailure) return "as the name says";
  static thread_local std::string text;
  const std::lock_guard lock(oneAtATime());
  text = "a kernel used " + device().told;
  return text.c_str();
}

cudaError_t cudaStreamCreateWithFlags(cudaStream_t* stream, unsigned /*flags*/) {
  const Call call("cudaStreamCreateWithFlags");
  if (call.injected()) return remembered(*call.injected());
  *stream = new CUstream_st();
  device().streams.insert(*stream);
  ++counts().streams;
  return cudaSuccess;
}

cudaError_t cudaStreamDestroy(cudaStream_t stream) {
  const Call call("cudaStreamDestroy");
  if (call.injected()) return remembered(*call.injected());
  if (device().streams.erase(stream) == 0) return remembered(cudaErrorInvalidResourceHandle);
  // The real one lets what is in the stream come to its end.
  const cudaError_t result = drain(stream);
  delete stream;
  --counts().streams;
  return remembered(result);
}

cudaError_t cudaStreamSynchronize(cudaStream_t stream) {
  const Call call("cudaStreamSynchronize");
  if (call.injected()) return remembered(*call.injected());
  if (!device().streams.contains(&streamOf(stream))) {
    return remembered(cudaErrorInvalidResourceHandle);
  }
  return remembered(drain(stream));
}

cudaError_t cudaDeviceSynchronize() {
  const Call call("cudaDeviceSynchronize");
  if (call.injected()) return remembered(*call.injected());
  return remembered(drain(std::nullopt));
}

cudaError_t cudaEventCreate(cudaEvent_t* event) {
  const Call call("cudaEventCreate");
  if (call.injected()) return remembered(*call.injected());
  *event = new CUevent_st();
  device().events.insert(*event);
  ++counts().events;
  return cudaSuccess;
}

cudaError_t cudaEventDestroy(cudaEvent_t event) {
  const Call call("cudaEventDestroy");
  if (call.injected()) return remembered(*call.injected());
  if (device().events.erase(event) == 0) return remembered(cudaErrorInvalidResourceHandle);
  delete event;
  --counts().events;
  return cudaSuccess;
}

cudaError_t cudaEventRecord(cudaEvent_t event, cudaStream_t stream) {
  const Call call("cudaEventRecord");
  if (call.injected()) return remembered(*call.injected());
  if (!device().events.contains(event)) return remembered(cudaErrorInvalidResourceHandle);
  event->recorded = true;
  event->reached = false;
  event->stream = stream;
  queueWork(stream, [event] {
    // It may be gone by now, which harms nobody.
    if (!device().events.contains(event)) return;
    event->reached = true;
    event->when = Clock::now();
  });
  return cudaSuccess;
}

cudaError_t cudaEventSynchronize(cudaEvent_t event) {
  const Call call("cudaEventSynchronize");
  if (call.injected()) return remembered(*call.injected());
  if (!device().events.contains(event)) return remembered(cudaErrorInvalidResourceHandle);
  return remembered(event->recorded && !event->reached ? drain(event->stream) : cudaSuccess);
}

cudaError_t cudaEventElapsedTime(float* ms, cudaEvent_t begin, cudaEvent_t end) {
  const Call call("cudaEventElapsedTime");
  if (call.injected()) return remembered(*call.injected());
  if (!begin->reached || !end->reached) return remembered(cudaErrorInvalidResourceHandle);
  *ms = std::chrono::duration<float, std::milli>(end->when - begin->when).count();
  return cudaSuccess;
}
