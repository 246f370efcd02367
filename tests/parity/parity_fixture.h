// Two paths side by side: the host's stages, and those under test.
#pragma once

#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <string>
#include <utility>

#include "cuda/cuda_path.h"
#include "gles/references_gles.h"
#include "gles/stage_set_gles.h"
#include "stages/reference_host.h"
#include "stages/stage_set.h"
#include "support/backends.h"
#include "support/tolerances.h"

namespace rangepose::test {

/// A path with what it needs, or why it is not here.
struct ParitySubject {
  std::unique_ptr<gles::Context> context;
  std::unique_ptr<StageSet> stages;
};

/// "glsl", "glsl_on_desktop_gl", "cuda" (whatever interop works), "cuda_gles", "cuda_gl",
/// "cuda_copy" or "cuda_staged". Throws Unavailable.
inline ParitySubject openSubject(const std::string& name) {
  ParitySubject subject;
  if (name.rfind("glsl", 0) == 0) {
    gles::ContextOptions options;
    options.debug = true;
    options.api = name == "glsl" ? gles::Api::kGles : gles::Api::kDesktop;
    subject.context = std::make_unique<gles::Context>(options);
    subject.stages = gles::makeGlesStages(*subject.context);
    return subject;
  }
  cuda::PathOptions options;
  if (name == "cuda_gles") options.interop = cuda::Interop::kGles;
  if (name == "cuda_gl") options.interop = cuda::Interop::kGl;
  if (name == "cuda_copy") options.interop = cuda::Interop::kCopy;
  options.staged = name == "cuda_staged";
  cuda::Path path = cuda::openPath(options);
  subject.context = std::move(path.context);
  subject.stages = std::move(path.stages);
  return subject;
}

/// Whether a path that is missing is a failure. "cuda" alone does not ask for a kind of interop:
/// another is then in use.
inline bool subjectRequired(const std::string& name) {
  if (name == "glsl") return backendRequired("gles");
  if (name == "cuda_gles" || name == "cuda_gl") return backendRequired(name);
  return (name == "cuda" || name == "cuda_copy" || name == "cuda_staged") &&
         backendRequired("cuda");
}

/// Each test must have done something on the device: a path that quietly falls back to the host
/// compares it with itself.
class Parity : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    try {
      subject_ = openSubject(GetParam());
    } catch (const Unavailable& error) {
      if (subjectRequired(GetParam())) FAIL() << error.what();
      GTEST_SKIP() << error.what();
    }
    host_ = makeHostStages();
  }
  void TearDown() override {
    if (!subject_.stages || IsSkipped() || HasFatalFailure()) return;
    const DeviceWork work = subject_.stages->work();
    EXPECT_GT(work.draws + work.launches, 0) << "nothing ran on the device";
    EXPECT_EQ(host_->work().draws, 0);
    subject_.stages.reset();  // before its context
  }
  StageSet& subject() { return *subject_.stages; }
  StageSet& host() { return *host_; }
  bool onGlsl() const { return std::string(GetParam()).rfind("glsl", 0) == 0; }
  gles::Context& context() { return *subject_.context; }
  /// Whether the subject renders by GL: where there is none, the host does it for CUDA.
  bool drawsByGl() const { return subject_.context != nullptr; }
  /// By GL where the subject has it, else on the host.
  void renderReferences(ReferenceObject& object) {
    if (subject_.context) {
      gles::renderReferences(*subject_.context, object, {});
    } else {
      host::renderReferences(object, {}, {});
    }
  }
  /// Floats that a root or a quotient may be off by: CUDA and llvmpipe round as the host does.
  std::int64_t deviceUlps() const {
    return onGlsl() && !subject_.context->info().software ? kDeviceUlps : 0;
  }

 private:
  ParitySubject subject_;
  std::unique_ptr<StageSet> host_;
};

/// One window of an image with a mask.
inline std::unique_ptr<ResidentScene> prepared(StageSet& stages,
                                               const DepthImage& image,
                                               const Image<std::uint8_t>& keep,
                                               const WindowTask& window) {
  const std::unique_ptr<ResidentDepth> depth = stages.foreground->upload(image, keep);
  return std::move(stages.scenes->prepare(*depth, {window}, {}).front());
}

/// The name of an instance is that of its subject.
#define RP_PARITY_SUBJECTS(Suite)                                \
  INSTANTIATE_TEST_SUITE_P(,                                     \
                           Suite,                                \
                           testing::Values("glsl",               \
                                           "glsl_on_desktop_gl", \
                                           "cuda",               \
                                           "cuda_gles",          \
                                           "cuda_gl",            \
                                           "cuda_copy",          \
                                           "cuda_staged"),       \
                           [](const auto& instance) { return std::string(instance.param); })

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
