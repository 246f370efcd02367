#include "io/io_support.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <iterator>
#include <random>
#include <stdexcept>
#include <system_error>

#include "core/error.h"

// assimp does not free what it had built when an import fails.
extern "C" const char* __lsan_default_suppressions();   // NOLINT(bugprone-reserved-identifier)
extern "C" const char* __lsan_default_suppressions() {  // NOLINT(bugprone-reserved-identifier)
  return "leak:libassimp";
}

namespace rangepose::test {

namespace fs = std::filesystem;

std::string bytesOf(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::string errorOf(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    std::string text = error.what();
    EXPECT_FALSE(text.empty());
    EXPECT_EQ(text.find('\n'), std::string::npos) << text;
    return text;
  }
  return "";
}

void expectTruncationsRefused(const std::string& name,
                              std::string_view whole,
                              std::size_t complete,
                              const std::function<void(const fs::path&)>& read) {
  const TempFolder folder;
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  const std::size_t step = whole.size() / 150 + 1;
  for (std::size_t length = 0; length < whole.size(); ++length) {
    const bool near_end = length < 16 || length + 16 > complete;
    if (!near_end && length % step != 0) continue;
    const fs::path path = folder.write(name, whole.substr(0, length));
    const std::string error = errorOf([&] { read(path); });
    if (length < complete) {
      EXPECT_NE(error, "") << name << " cut to " << length << " of " << whole.size() << " bytes";
    }
  }
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

void expectDamageSurvived(const std::string& name,
                          std::string_view whole,
                          const std::function<void(const fs::path&)>& read) {
  const TempFolder folder;
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  std::mt19937 random(7);
  for (int trial = 0; trial < 300; ++trial) {
    std::string damaged(whole);
    for (int change = 0; change <= trial % 3; ++change) {
      damaged[random() % damaged.size()] = static_cast<char>(random() & 0xff);
    }
    const fs::path path = folder.write(name, damaged);
    errorOf([&] { read(path); });
  }
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

}  // namespace rangepose::test
