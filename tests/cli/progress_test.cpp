#include "rangepose/progress.h"

#include <gmock/gmock.h>

#include <sstream>

namespace rangepose::cli {
namespace {

using namespace std::chrono_literals;

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
  std::ostringstream out;
  {
    Progress progress(out, "a", 10, {true, 0ms, 1ms});
    progress.update(5);
    std::this_thread::sleep_for(50ms);
  }
  EXPECT_THAT(out.str(), ::testing::HasSubstr("5/10"));
  const std::string text = out.str();
  const std::size_t last_but_one = text.rfind('\r', text.size() - 2);
  ASSERT_EQ(text.back(), '\r');
  ASSERT_NE(last_but_one, std::string::npos);
  EXPECT_EQ(text.substr(last_but_one + 1).find_first_not_of(" \r"), std::string::npos);
}

}  // namespace
}  // namespace rangepose::cli
