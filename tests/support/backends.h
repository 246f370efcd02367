// Tests that need a back-end: skipped where it is missing, failed where RP_REQUIRE_BACKENDS names
// it.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <optional>
#include <sstream>
#include <string>

#include "core/error.h"
#include "gles/context.h"

namespace rangepose::test {

/// Whether the comma-separated list RP_REQUIRE_BACKENDS (e.g. "gles,cuda") holds `name`: gles,
/// cuda, or a kind of interop by which CUDA shares textures, cuda_gles or cuda_gl.
inline bool backendRequired(const std::string& name) {
  const char* list = std::getenv("RP_REQUIRE_BACKENDS");
  std::istringstream words(list == nullptr ? "" : list);
  for (std::string word; std::getline(words, word, ',');) {
    if (word == name) return true;
  }
  return false;
}

/// A GLES context for each test.
class GlesFixture : public testing::Test {
 protected:
  void SetUp() override {
    try {
      gles::ContextOptions options;
      options.debug = true;
      context_.emplace(options);
    } catch (const Unavailable& error) {
      if (backendRequired("gles")) FAIL() << error.what();
      GTEST_SKIP() << error.what();
    }
  }
  gles::Context& context() { return *context_; }

 private:
  std::optional<gles::Context> context_;
};

}  // namespace rangepose::test
