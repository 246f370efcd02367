// In place of the tests on a device where there is no CUDA toolkit: seen to be skipped.
#include <gtest/gtest.h>

#include "support/backends.h"

namespace rangepose {
namespace {

TEST(CudaGpuTest, KernelsWereBuilt) {
  constexpr const char* kWhy = "built without CUDA: no test of a kernel is in this build";
  if (test::backendRequired("cuda")) FAIL() << kWhy;
  GTEST_SKIP() << kWhy;
}

}  // namespace
}  // namespace rangepose
