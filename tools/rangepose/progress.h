// A progress line on a terminal for work that takes longer than two seconds.
#pragma once

#include <chrono>
#include <condition_variable>
#include <iosfwd>
#include <mutex>
#include <string>
#include <thread>

namespace rangepose::cli {

struct ProgressOptions {
  bool enabled = false;                   ///< nothing is ever written when false
  std::chrono::milliseconds delay{2000};  ///< nothing is written before
  std::chrono::milliseconds period{100};  ///< between two lines
};

/// The options for stderr: enabled where it is a terminal.
ProgressOptions terminalProgress();

/// "elbow  [=====>    ]  512/1024  3 s left"; without a total "elbow  12 s".
std::string progressLine(const std::string& label, int done, int total, double elapsed_s);

/// Draws over one line of `out`, which must outlive it, by a thread of its own, and wipes it at the
/// end. Any thread may call its functions.
class Progress {
 public:
  /// total 0: unknown, the time is shown.
  Progress(std::ostream& out, std::string label, int total, const ProgressOptions& options);
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  ~Progress();

  void update(int done);
  /// Wipes the line, so that other text may be written; it comes back after the next period.
  void clear();

 private:
  void draw();
  void wipe();
  std::ostream& out_;
  const std::string label_;
  const int total_;
  const ProgressOptions options_;
  const std::chrono::steady_clock::time_point begin_;
  std::mutex mutex_;
  std::condition_variable stopped_;
  bool stop_ = false;
  int done_ = 0;
  std::size_t drawn_ = 0;  ///< characters on the line now
  std::thread thread_;
};

}  // namespace rangepose::cli
