#include "rangepose/progress.h"

#include <gmock/gmock.h>

#include <condition_variable>
#include <mutex>
#include <ostream>
#include <sstream>
#include <streambuf>
#include <string>
#include <thread>

namespace rangepose::cli {
namespace {

using namespace std::chrono_literals;

/// What was written, also while it is being written.
class WatchedText : public std::streambuf {
 public:
  void waitFor(const std::string& words) {
    std::unique_lock<std::mutex> lock(mutex_);
    written_.wait(lock, [&] { return text_.find(words) != std::string::npos; });
  }
  std::string text() {
    const std::lock_guard<std::mutex> lock(mutex_);
    return text_;
  }

 protected:
  int overflow(int character) override {
    const char one = static_cast<char>(character);
    return xsputn(&one, 1) == 1 ? character : EOF;
  }
  std::streamsize xsputn(const char* characters, std::streamsize count) override {
    const std::lock_guard<std::mutex> lock(mutex_);
    text_.append(characters, static_cast<std::size_t>(count));
    written_.notify_all();
    return count;
  }

 private:
  std::mutex mutex_;
  std::condition_variable written_;
  std::string text_;
};

TEST(ProgressTest, LineShowsShareAndTimeLeft) {
  EXPECT_EQ(progressLine("elbow", 0, 8, 1.0), "elbow  [>                             ]  0/8");
  EXPECT_EQ(progressLine("elbow", 4, 8, 3.0),
            "elbow  [===============>              ]  4/8  3 s left");
  EXPECT_EQ(progressLine("elbow", 8, 8, 6.0),
            "elbow  [==============================]  8/8  0 s left");
  EXPECT_EQ(progressLine("estimating", 0, 0, 12.0), "estimating  12 s");
}

TEST(ProgressTest, ShortWorkWritesNothing) {
  std::ostringstream out;
  {
    Progress progress(out, "a", 10, {true, 1h, 1ms});
    progress.update(5);
  }
  EXPECT_EQ(out.str(), "");
}

TEST(ProgressTest, DisabledWritesNothing) {
  std::ostringstream out;
  {
    Progress progress(out, "a", 10, {false, 0ms, 1ms});
    std::this_thread::sleep_for(20ms);
  }
  EXPECT_EQ(out.str(), "");
}

TEST(ProgressTest, LineIsWipedAtTheEnd) {
  WatchedText text_of_line;
  std::ostream out(&text_of_line);
  {
    Progress progress(out, "a", 10, {true, 0ms, 1ms});
    progress.update(5);
    text_of_line.waitFor("5/10");
  }
  const std::string text = text_of_line.text();
  const std::size_t last_but_one = text.rfind('\r', text.size() - 2);
  ASSERT_EQ(text.back(), '\r');
  ASSERT_NE(last_but_one, std::string::npos);
  EXPECT_EQ(text.substr(last_but_one + 1).find_first_not_of(" \r"), std::string::npos);
}

}  // namespace
}  // namespace rangepose::cli
