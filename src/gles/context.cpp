#include "gles/context.h"

#include <array>
#include <cstring>
#include <utility>

#include "core/error.h"
#include "gles/gl_text.h"
#include "gles/handle.h"

namespace rangepose::gles {
namespace {

constexpr const char* kInstall =
    "; install an EGL driver, e.g. apt-get install libegl1 libgles2 libgl1-mesa-dri";

constexpr const char* kUsedByGles[] = {
    "GL_EXT_color_buffer_float", "GL_KHR_debug", "GL_EXT_gpu_shader5"};
/// Float targets and `precise` are part of OpenGL 4.5, but shaders of GLES 3.1 know no `precise`
/// without the extension.
constexpr const char* kUsedByDesktop[] = {
    "GL_ARB_ES3_1_compatibility", "GL_KHR_debug", "GL_EXT_gpu_shader5"};
constexpr const char* kPrecise = "GL_EXT_gpu_shader5";
constexpr const char* kShadersOfGles = "GL_ARB_ES3_1_compatibility";
constexpr GLenum kProgramPointSize = 0x8642;  // GL_PROGRAM_POINT_SIZE, not in GLES headers

/// What the debug callback leaves for checkGl.
struct DebugLog {
  std::string first_error;
};

void GL_APIENTRY keepFirstError(
    GLenum, GLenum type, GLuint, GLenum, GLsizei, const GLchar* message, const void* user) {
  if (type != GL_DEBUG_TYPE_ERROR_KHR) return;
  auto* log = static_cast<DebugLog*>(const_cast<void*>(user));
  if (log->first_error.empty()) log->first_error = message;
}

/// Renders one value into a texture of the format and reads it back.
bool rendersFloats(GLenum format) {
  constexpr float kValue = 1234.5678f;  // not representable in 16 bits
  GLuint name = 0;
  glGenTextures(1, &name);
  const TextureHandle texture(name);
  glBindTexture(GL_TEXTURE_2D, texture.id());
  glTexStorage2D(GL_TEXTURE_2D, 1, format, 2, 2);
  glGenFramebuffers(1, &name);
  const FramebufferHandle framebuffer(name);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.id());
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture.id(), 0);
  bool works = glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
  if (works) {
    const float color[] = {kValue, 0.0f, 0.0f, 0.0f};
    std::array<float, 4> read{};
    glClearBufferfv(GL_COLOR, 0, color);
    glReadPixels(0, 0, 1, 1, GL_RGBA, GL_FLOAT, read.data());
    works = glGetError() == GL_NO_ERROR && read[0] == kValue;
  }
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  while (glGetError() != GL_NO_ERROR) continue;
  return works;
}

}  // namespace

struct Context::State {
  State(const DisplaySource& source, const ContextOptions& options);
  State(const State&) = delete;
  State& operator=(const State&) = delete;
  ~State();
  bool desktop() const { return info.api == Api::kDesktop; }
  EGLConfig chooseConfig() const;
  EGLContext createContext(EGLConfig config, int major, int minor, bool debug) const;
  void create(bool debug);
  void describe();
  void prepareDesktop() const;
  void listenToDebug();
  void requireFloatTargets() const;
  void destroy() noexcept;

  Display display;
  EGLContext context = EGL_NO_CONTEXT;
  EGLSurface surface = EGL_NO_SURFACE;
  ContextInfo info;
  DebugLog log;
};

Context::State::State(const DisplaySource& source, const ContextOptions& options)
    : display(source) {
  info.platform = source.name;
  info.api = options.api;
  try {
    create(options.debug);
    describe();
    if (desktop()) prepareDesktop();
    requireFloatTargets();
    listenToDebug();
  } catch (...) {
    destroy();
    throw;
  }
}

Context::State::~State() { destroy(); }

void Context::State::destroy() noexcept {
  if (context != EGL_NO_CONTEXT) {
    eglBindAPI(desktop() ? EGL_OPENGL_API : EGL_OPENGL_ES_API);
    if (eglGetCurrentContext() == context) {
      eglMakeCurrent(display.get(), EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    }
    eglDestroyContext(display.get(), context);
    context = EGL_NO_CONTEXT;
  }
  if (surface != EGL_NO_SURFACE) {
    eglDestroySurface(display.get(), surface);
    surface = EGL_NO_SURFACE;
  }
}

EGLConfig Context::State::chooseConfig() const {
  const EGLint renderable = desktop() ? EGL_OPENGL_BIT : EGL_OPENGL_ES3_BIT;
  for (const EGLint surfaces : {EGL_PBUFFER_BIT, EGL_DONT_CARE}) {
    const EGLint wanted[] = {EGL_SURFACE_TYPE, surfaces, EGL_RENDERABLE_TYPE, renderable, EGL_NONE};
    EGLConfig config = nullptr;
    EGLint count = 0;
    if (eglChooseConfig(display.get(), wanted, &config, 1, &count) == EGL_TRUE && count > 0) {
      return config;
    }
  }
  throw Unavailable(info.platform + ": no configuration for OpenGL" + (desktop() ? "" : " ES 3"));
}

EGLContext Context::State::createContext(EGLConfig config, int major, int minor, bool debug) const {
  std::vector<EGLint> attributes = {
      EGL_CONTEXT_MAJOR_VERSION, major, EGL_CONTEXT_MINOR_VERSION, minor};
  if (desktop()) {
    attributes.insert(attributes.end(),
                      {EGL_CONTEXT_OPENGL_PROFILE_MASK, EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT});
  }
  if (debug) attributes.insert(attributes.end(), {EGL_CONTEXT_OPENGL_DEBUG, EGL_TRUE});
  attributes.push_back(EGL_NONE);
  return eglCreateContext(display.get(), config, EGL_NO_CONTEXT, attributes.data());
}

void Context::State::create(bool debug) {
  const char* name = desktop() ? "OpenGL" : "OpenGL ES";
  if (eglBindAPI(desktop() ? EGL_OPENGL_API : EGL_OPENGL_ES_API) != EGL_TRUE) {
    throw Unavailable(info.platform + ": no " + name);
  }
  EGLConfig config = chooseConfig();
  const int major = desktop() ? 4 : 3;
  const int least = desktop() ? 5 : 1;
  for (int minor = least + 1; minor >= least && context == EGL_NO_CONTEXT; --minor) {
    context = createContext(config, major, minor, debug);
  }
  if (context == EGL_NO_CONTEXT) {
    throw Unavailable(info.platform + ": no " + name + " " + std::to_string(major) + "." +
                      std::to_string(least) + " (" + eglErrorName(eglGetError()) + ")");
  }
  if (!display.has("EGL_KHR_surfaceless_context")) {
    const EGLint size[] = {EGL_WIDTH, 1, EGL_HEIGHT, 1, EGL_NONE};
    surface = eglCreatePbufferSurface(display.get(), config, size);
  }
  if (eglMakeCurrent(display.get(), surface, surface, context) != EGL_TRUE) {
    throw Unavailable(info.platform + ": context cannot be made current (" +
                      eglErrorName(eglGetError()) + ")");
  }
}

void Context::State::describe() {
  info.vendor = glText(GL_VENDOR);
  info.renderer = glText(GL_RENDERER);
  info.version = glText(GL_VERSION);
  info.glsl_version = glText(GL_SHADING_LANGUAGE_VERSION);
  for (const char* name : {"llvmpipe", "softpipe", "swrast", "SwiftShader"}) {
    info.software = info.software || info.renderer.find(name) != std::string::npos;
  }
  const std::string all = glExtensions();
  for (const char* name : desktop() ? kUsedByDesktop : kUsedByGles) {
    const bool found = hasWord(all.c_str(), name);
    (found ? info.extensions : info.missing).emplace_back(name);
    if (found && std::strcmp(name, kPrecise) == 0) info.precise = true;
  }
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &info.max_texture_size);
  glGetIntegerv(GL_MAX_DRAW_BUFFERS, &info.max_draw_buffers);
}

void Context::State::prepareDesktop() const {
  if (!hasWord(glExtensions().c_str(), kShadersOfGles)) {
    throw Unavailable(info.platform + " (" + info.renderer + "): no " + kShadersOfGles);
  }
  // In GLES shaders always set the size of points.
  glEnable(kProgramPointSize);
}

void Context::State::requireFloatTargets() const {
  if (!rendersFloats(GL_RGBA32F) || !rendersFloats(GL_R32F)) {
    throw Unavailable(info.platform + " (" + info.renderer +
                      "): cannot render to 32-bit float textures (GL_EXT_color_buffer_float)");
  }
}

void Context::State::listenToDebug() {
  if (!hasWord(glExtensions().c_str(), "GL_KHR_debug")) return;
  // The extension adds no suffix in desktop GL.
  const auto set_callback = reinterpret_cast<PFNGLDEBUGMESSAGECALLBACKKHRPROC>(
      eglGetProcAddress(desktop() ? "glDebugMessageCallback" : "glDebugMessageCallbackKHR"));
  if (set_callback == nullptr) return;
  set_callback(keepFirstError, &log);
  glEnable(GL_DEBUG_OUTPUT_KHR);
  glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS_KHR);
  while (glGetError() != GL_NO_ERROR) continue;
}

Context::Context(const ContextOptions& options) {
  std::string reasons;
  for (const DisplaySource& source : displaySources(options.cuda_device)) {
    try {
      state_ = std::make_unique<State>(source, options);
      return;
    } catch (const Unavailable& error) {
      reasons += (reasons.empty() ? "" : "; ") + std::string(error.what());
    }
  }
  const char* name = options.api == Api::kDesktop ? "OpenGL 4.5" : "OpenGL ES 3.1";
  throw Unavailable("no headless " + std::string(name) + " with float targets here: " + reasons +
                    kInstall);
}

Context::Context(const DisplaySource& source, const ContextOptions& options)
    : state_(std::make_unique<State>(source, options)) {}

Context::Context(Context&&) noexcept = default;
Context& Context::operator=(Context&&) noexcept = default;
Context::~Context() = default;

void Context::makeCurrent() {
  // The API that is bound on this thread may be that of another context.
  eglBindAPI(state_->desktop() ? EGL_OPENGL_API : EGL_OPENGL_ES_API);
  if (eglGetCurrentContext() == state_->context) return;
  const EGLSurface surface = state_->surface;
  if (eglMakeCurrent(state_->display.get(), surface, surface, state_->context) != EGL_TRUE) {
    throw Error("EGL context cannot be made current on this thread (" +
                eglErrorName(eglGetError()) + "); release() it on the thread that has it");
  }
}

void Context::makeCurrentIfPossible() noexcept {
  try {
    makeCurrent();
  } catch (const Error&) {
    return;
  }
}

void Context::release() {
  eglMakeCurrent(state_->display.get(), EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
}

const ContextInfo& Context::info() const { return state_->info; }

void Context::checkGl(const std::string& where) {
  const GLenum error = glGetError();
  std::string& message = state_->log.first_error;
  if (error == GL_NO_ERROR && message.empty()) return;
  while (glGetError() != GL_NO_ERROR) continue;
  std::string text = "GL error at " + where + ": " + glErrorName(error);
  if (error == GL_NO_ERROR) text = "GL error at " + where;
  if (!message.empty()) text += ": " + oneLine(std::exchange(message, {}));
  throw Error(text);
}

}  // namespace rangepose::gles
