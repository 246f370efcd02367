#include "rangepose/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <ostream>
#include <utility>

namespace rangepose::cli {

ProgressOptions terminalProgress() {
  ProgressOptions options;
  options.enabled = isatty(STDERR_FILENO) == 1;
  return options;
}

std::string progressLine(const std::string& label, int done, int total, double elapsed_s) {
  if (total <= 0) return fmt::format("{}  {:.0f} s", label, elapsed_s);
  constexpr int kWidth = 30;
  const double share = std::clamp(static_cast<double>(done) / total, 0.0, 1.0);
  const int filled = static_cast<int>(share * kWidth);
  std::string bar(static_cast<std::size_t>(filled), '=');
  if (filled < kWidth) bar += '>';
  bar.resize(kWidth, ' ');
  std::string line = fmt::format("{}  [{}]  {}/{}", label, bar, done, total);
  if (share > 0.0) line += fmt::format("  {:.0f} s left", elapsed_s * (1.0 - share) / share);
  return line;
}

Progress::Progress(std::ostream& out, std::string label, int total, const ProgressOptions& options)
    : out_(out),
      label_(std::move(label)),
      total_(total),
      options_(options),
      begin_(std::chrono::steady_clock::now()) {
  if (!options_.enabled) return;
  thread_ = std::thread([this] {
    std::unique_lock<std::mutex> lock(mutex_);
    if (stopped_.wait_for(lock, options_.delay, [this] { return stop_; })) return;
    do draw();
    while (!stopped_.wait_for(lock, options_.period, [this] { return stop_; }));
  });
}

Progress::~Progress() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stop_ = true;
  }
  stopped_.notify_all();
  if (thread_.joinable()) thread_.join();
  wipe();
}

void Progress::update(int done) {
  const std::lock_guard<std::mutex> lock(mutex_);
  done_ = done;
}

void Progress::clear() {
  const std::lock_guard<std::mutex> lock(mutex_);
  wipe();
}

void Progress::draw() {
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin_;
  const std::string line = progressLine(label_, done_, total_, elapsed.count());
  const std::size_t left_over = drawn_ > line.size() ? drawn_ - line.size() : 0;
  out_ << '\r' << line << std::string(left_over, ' ') << std::flush;
  drawn_ = line.size();
}

void Progress::wipe() {
  if (drawn_ == 0) return;
  out_ << '\r' << std::string(drawn_, ' ') << '\r' << std::flush;
  drawn_ = 0;
}

}  // namespace rangepose::cli
