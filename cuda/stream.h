// Streams and events with owners.
#pragma once

#include <cuda_runtime_api.h>

namespace rangepose::cuda {

/// Does not wait for the default stream.
class Stream {
 public:
  Stream();
  Stream(Stream&& other) noexcept;
  Stream& operator=(Stream&& other) noexcept;
  Stream(const Stream&) = delete;
  Stream& operator=(const Stream&) = delete;
  ~Stream();

  cudaStream_t get() const { return stream_; }
  /// Waits for all that was given to it.
  void synchronize() const;

 private:
  cudaStream_t stream_ = nullptr;
};

/// Waits for a stream where a function is left by an exception, so that no copy is on its way to
/// memory of the host that goes. To be declared after that memory.
class Landing {
 public:
  explicit Landing(cudaStream_t stream);
  Landing(const Landing&) = delete;
  Landing& operator=(const Landing&) = delete;
  ~Landing();

 private:
  cudaStream_t stream_;
  int exceptions_;
};

/// A moment in a stream.
class Event {
 public:
  Event();
  Event(Event&& other) noexcept;
  Event& operator=(Event&& other) noexcept;
  Event(const Event&) = delete;
  Event& operator=(const Event&) = delete;
  ~Event();

  void record(cudaStream_t stream);
  /// Waits until the stream has come to it.
  void synchronize() const;

 private:
  friend float elapsedMs(const Event& begin, const Event& end);
  cudaEvent_t event_ = nullptr;
};

/// Device time between two recorded events [ms]; waits for the second.
float elapsedMs(const Event& begin, const Event& end);

}  // namespace rangepose::cuda
