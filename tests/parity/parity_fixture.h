// Two paths side by side: the host's stages, and those under test.
#pragma once

#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <cstdlib>
#include <memory>

#include "gles/stage_set_gles.h"
#include "stages/stage_set.h"
#include "support/backends.h"

namespace rangepose::test {

/// Each test must have drawn something: a path that quietly falls back to the host compares it with
/// itself.
class Parity : public GlesFixture {
 protected:
  void SetUp() override {
    GlesFixture::SetUp();
    if (IsSkipped() || HasFatalFailure()) return;
    subject_ = gles::makeGlesStages(context());
    host_ = makeHostStages();
  }
  void TearDown() override {
    if (!subject_ || HasFatalFailure()) return;
    EXPECT_GT(subject_->work().draws, 0) << "nothing ran on the device";
    EXPECT_EQ(host_->work().draws, 0);
    subject_.reset();
  }
  StageSet& subject() { return *subject_; }
  StageSet& host() { return *host_; }

 private:
  std::unique_ptr<StageSet> subject_;
  std::unique_ptr<StageSet> host_;
};

/// Floats between two values: 0 for equal ones (also +0 and -0).
inline std::int64_t ulpsBetween(float a, float b) {
  const auto ordered = [](float value) {
    const auto bits = std::bit_cast<std::int32_t>(value);
    return bits < 0 ? -static_cast<std::int64_t>(bits & 0x7fffffff)
                    : static_cast<std::int64_t>(bits);
  };
  return std::llabs(ordered(a) - ordered(b));
}

/// Pixels that are not equal.
template <typename T>
int differences(const Image<T>& a, const Image<T>& b) {
  if (a.width() != b.width() || a.height() != b.height()) return -1;
  int count = 0;
  for (std::size_t i = 0; i < a.size(); ++i) count += a.data()[i] == b.data()[i] ? 0 : 1;
  return count;
}

}  // namespace rangepose::test
