#include "cuda/stream.h"

#include <exception>
#include <utility>

#include "cuda/check.h"

namespace rangepose::cuda {

Stream::Stream() { RP_CUDA(cudaStreamCreateWithFlags(&stream_, cudaStreamNonBlocking)); }
Stream::Stream(Stream&& other) noexcept : stream_(std::exchange(other.stream_, nullptr)) {}
Stream& Stream::operator=(Stream&& other) noexcept {
  std::swap(stream_, other.stream_);
  return *this;
}
Stream::~Stream() {
  if (stream_ != nullptr) cudaStreamDestroy(stream_);
}
void Stream::synchronize() const { RP_CUDA(cudaStreamSynchronize(stream_)); }

Landing::Landing(cudaStream_t stream) : stream_(stream), exceptions_(std::uncaught_exceptions()) {}
Landing::~Landing() {
  if (std::uncaught_exceptions() > exceptions_) cudaStreamSynchronize(stream_);
}

Event::Event() { RP_CUDA(cudaEventCreate(&event_)); }
Event::Event(Event&& other) noexcept : event_(std::exchange(other.event_, nullptr)) {}
Event& Event::operator=(Event&& other) noexcept {
  std::swap(event_, other.event_);
  return *this;
}
Event::~Event() {
  if (event_ != nullptr) cudaEventDestroy(event_);
}
void Event::record(cudaStream_t stream) { RP_CUDA(cudaEventRecord(event_, stream)); }
void Event::synchronize() const { RP_CUDA(cudaEventSynchronize(event_)); }

float elapsedMs(const Event& begin, const Event& end) {
  float ms = 0.0f;
  end.synchronize();
  RP_CUDA(cudaEventElapsedTime(&ms, begin.event_, end.event_));
  return ms;
}

}  // namespace rangepose::cuda
