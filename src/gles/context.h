// A GLES 3.1+ context without a display or window; or one of desktop GL that takes the same
// shaders.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "gles/egl_display.h"
#include "gles/gl.h"

namespace rangepose::gles {

enum class Api {
  kGles,     ///< OpenGL ES 3.1 or 3.2
  kDesktop,  ///< OpenGL 4.5 core with GL_ARB_ES3_1_compatibility: where CUDA shares only its
             ///< textures
};

struct ContextOptions {
  int cuda_device = -1;  ///< prefer the EGL device of this CUDA device; -1: none in particular
  bool debug = false;    ///< ask the driver for a debug context (slower, tells more)
  Api api = Api::kGles;
};

struct ContextInfo {
  Api api = Api::kGles;
  std::string platform;  ///< the EGL display in use, e.g. "device 0", "surfaceless"
  std::string vendor;
  std::string renderer;
  std::string version;
  std::string glsl_version;
  bool software = false;                ///< a software rasteriser: llvmpipe, softpipe or swrast
  bool precise = false;                 ///< GLSL has `precise`: no contraction of a * b + c
  std::vector<std::string> extensions;  ///< of those that rangepose uses, the ones found
  std::vector<std::string> missing;     ///< of those that rangepose uses, the ones not found
  int max_texture_size = 0;             ///< [px]
  int max_draw_buffers = 0;
};

/// Everything else in this folder needs one, current on the calling thread, and must not outlive
/// it.
class Context {
 public:
  /// Made current on the calling thread. Throws Unavailable, saying what is missing and what to
  /// install.
  explicit Context(const ContextOptions& options = {});
  /// On this display and no other.
  Context(const DisplaySource& source, const ContextOptions& options);
  Context(Context&&) noexcept;
  Context& operator=(Context&&) noexcept;
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;
  ~Context();

  /// Makes it current on the calling thread, if it is not already. It must not be current on
  /// another one.
  void makeCurrent();
  /// The same for destructors, which must not delete what another context has under the same names:
  /// an error is left to those who use the context next.
  void makeCurrentIfPossible() noexcept;
  /// Lets another thread take it.
  void release();
  const ContextInfo& info() const;
  /// Throws Error when GL or its debug callback reported an error since the last call.
  void checkGl(const std::string& where);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace rangepose::gles
