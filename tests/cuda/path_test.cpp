// The CUDA path as the rest of the program sees it, with or without a toolkit and a device.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "cuda/cuda_path.h"
#include "support/backends.h"

namespace rangepose::cuda {
namespace {

using testing::HasSubstr;

TEST(CudaPathTest, InteropHasANameAndIsFoundByIt) {
  for (const Interop interop : {Interop::kAuto, Interop::kGles, Interop::kGl, Interop::kCopy}) {
    EXPECT_EQ(parseInterop(nameOf(interop)), interop);
  }
  EXPECT_THROW(parseInterop("wire"), Error);
  EXPECT_THROW(parseInterop(""), Error);
}

TEST(CudaPathTest, WhatIsMissingIsNamedByWhoeverAsks) {
  const Status found = status();
  if (found.missing.empty()) {
    EXPECT_FALSE(found.devices.empty());
    EXPECT_FALSE(found.toolkit.empty());
    EXPECT_EQ(openPath().stages->name, "cuda");
    return;
  }
  EXPECT_FALSE(test::backendRequired("cuda")) << found.missing;
  EXPECT_EQ(found.missing.find('\n'), std::string::npos);
  for (const Interop interop : {Interop::kAuto, Interop::kGles, Interop::kGl, Interop::kCopy}) {
    try {
      openPath({interop, false});
      ADD_FAILURE() << "opened without a device";
    } catch (const Unavailable& error) {
      EXPECT_THAT(error.what(), HasSubstr(found.missing));
    }
  }
  EXPECT_THROW(openContextOfDevice(), Unavailable);
}

TEST(CudaPathTest, ABuildWithAToolkitNamesIt) {
  // Without one, the reason is the build and not a driver.
  const Status found = status();
  if (found.toolkit.empty()) {
    EXPECT_THAT(found.missing, HasSubstr("built without CUDA"));
  } else {
    EXPECT_EQ(found.missing.find("built without CUDA"), std::string::npos);
  }
}

}  // namespace
}  // namespace rangepose::cuda
