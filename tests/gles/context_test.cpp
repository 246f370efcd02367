#include "gles/context.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <optional>
#include <thread>

#include "core/error.h"
#include "gles/device.h"
#include "gles/framebuffer.h"
#include "support/backends.h"

namespace rangepose::gles {
namespace {

using ContextTest = test::GlesFixture;
using testing::HasSubstr;

TEST_F(ContextTest, TellsWhatItFound) {
  const ContextInfo& info = context().info();
  EXPECT_FALSE(info.platform.empty());
  EXPECT_FALSE(info.vendor.empty());
  EXPECT_FALSE(info.renderer.empty());
  EXPECT_THAT(info.version, HasSubstr("OpenGL ES 3."));
  EXPECT_THAT(info.glsl_version, HasSubstr("ES"));
  EXPECT_GE(info.max_texture_size, 2048);
  EXPECT_GE(info.max_draw_buffers, 4);
  EXPECT_THAT(info.extensions, testing::Contains("GL_EXT_color_buffer_float"));
}

TEST_F(ContextTest, MovesAndStaysUsable) {
  Context moved = std::move(context());
  const Canvas canvas(Format::kR32f, 3, 2);
  canvas.framebuffer.clear(glm::vec4(2.5f));
  EXPECT_EQ(canvas.texture.downloadFloats().at(2, 1), 2.5f);
  moved.checkGl("after a move");
}

TEST_F(ContextTest, TwoContextsLiveAndDieApart) {
  {
    Context second;
    const Canvas canvas(Format::kR32f, 4, 4);
    second.checkGl("second context");
  }
  context().makeCurrent();
  const Canvas canvas(Format::kR32f, 4, 4);
  canvas.framebuffer.clear(glm::vec4(1.5f));
  EXPECT_EQ(canvas.texture.downloadFloats().at(0, 0), 1.5f);
}

TEST_F(ContextTest, AnotherThreadMayTakeIt) {
  context().release();
  float read = 0.0f;
  std::thread([&] {
    context().makeCurrent();
    const Canvas canvas(Format::kR32f, 1, 1);
    canvas.framebuffer.clear(glm::vec4(7.0f));
    read = canvas.texture.downloadFloats().at(0, 0);
    context().release();
  }).join();
  EXPECT_EQ(read, 7.0f);
}

TEST_F(ContextTest, ThrowsTheErrorOfACallOnce) {
  glBindTexture(GL_FRAMEBUFFER, 0);
  try {
    context().checkGl("this test");
    FAIL() << "no error was reported";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("this test"));
    EXPECT_THAT(error.what(), HasSubstr("GL_INVALID_ENUM"));
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
  }
  EXPECT_NO_THROW(context().checkGl("this test"));
}

TEST_F(ContextTest, ListsDevicesInOrder) {
  int index = 0;
  for (const EglDeviceInfo& device : listEglDevices()) EXPECT_EQ(device.index, index++);
  // What the list says and what a context takes must agree.
  const bool on_a_device = context().info().platform.rfind("device ", 0) == 0;
  EXPECT_TRUE(index > 0 || !on_a_device);
}

TEST_F(ContextTest, AnUnknownCudaDeviceIsOnlyAPreference) {
  ContextOptions options;
  options.cuda_device = 4711;
  EXPECT_NO_THROW(Context{options});
}

/// A context of desktop GL for each test.
class DesktopContextTest : public testing::Test {
 protected:
  void SetUp() override {
    try {
      ContextOptions options;
      options.debug = true;
      options.api = Api::kDesktop;
      context_.emplace(options);
    } catch (const Unavailable& error) {
      GTEST_SKIP() << error.what();
    }
  }
  std::optional<Context> context_;
};

TEST_F(DesktopContextTest, TellsThatItIsOne) {
  const ContextInfo& info = context_->info();
  EXPECT_EQ(info.api, Api::kDesktop);
  EXPECT_EQ(info.version.find("OpenGL ES"), std::string::npos) << info.version;
  EXPECT_THAT(info.extensions, testing::Contains("GL_ARB_ES3_1_compatibility"));
}

TEST_F(DesktopContextTest, CompilesEveryProgram) {
  Device device(*context_);
  for (int id = 0; id < static_cast<int>(ProgramId::kCount); ++id) {
    EXPECT_NO_THROW(device.program(static_cast<ProgramId>(id)));
  }
  context_->checkGl("compiling");
}

TEST_F(DesktopContextTest, GivesWayToAGlesContextAndComesBack) {
  {
    Context gles;
    const Canvas canvas(Format::kR32f, 2, 2);
    gles.checkGl("a GLES context beside it");
  }
  context_->makeCurrent();
  const Canvas canvas(Format::kR32f, 2, 2);
  canvas.framebuffer.clear(glm::vec4(3.5f));
  EXPECT_EQ(canvas.texture.downloadFloats().at(1, 1), 3.5f);
  context_->checkGl("back again");
}

TEST(ContextDeathTest, WithoutADriverSaysWhatToInstall) {
  // A new process: the dispatch library reads the list of drivers once.
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const auto open = [] {
    setenv("__EGL_VENDOR_LIBRARY_FILENAMES", "/nonexistent", 1);
    try {
      const Context context;
    } catch (const Unavailable& error) {
      std::fprintf(stderr, "%s\n", error.what());
      std::_Exit(listEglDevices().empty() ? 3 : 4);
    }
    std::_Exit(0);
  };
  EXPECT_EXIT(
      open(), testing::ExitedWithCode(3), "no headless OpenGL ES.*libegl1.*libgl1-mesa-dri");
}

TEST(EglExtensions, AreMatchedAsWholeWords) {
  EXPECT_TRUE(hasWord("A_b A_bc", "A_bc"));
  EXPECT_TRUE(hasWord("A_bc A_b", "A_b"));
  EXPECT_FALSE(hasWord("A_bc XA_b", "A_b"));
  EXPECT_FALSE(hasWord("", "A_b"));
  EXPECT_FALSE(hasWord(nullptr, "A_b"));
}

}  // namespace
}  // namespace rangepose::gles
