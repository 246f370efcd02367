#include "gles/egl_display.h"

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <utility>

#include "core/error.h"

namespace rangepose::gles {
namespace {

struct DeviceFunctions {
  PFNEGLQUERYDEVICESEXTPROC devices = nullptr;
  PFNEGLQUERYDEVICESTRINGEXTPROC text = nullptr;
  PFNEGLQUERYDEVICEATTRIBEXTPROC attribute = nullptr;

  DeviceFunctions() {
    const char* client = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
    const bool listed =
        hasWord(client, "EGL_EXT_device_base") ||
        (hasWord(client, "EGL_EXT_device_enumeration") && hasWord(client, "EGL_EXT_device_query"));
    if (!listed || !hasWord(client, "EGL_EXT_platform_device")) return;
    devices = reinterpret_cast<PFNEGLQUERYDEVICESEXTPROC>(eglGetProcAddress("eglQueryDevicesEXT"));
    text = reinterpret_cast<PFNEGLQUERYDEVICESTRINGEXTPROC>(
        eglGetProcAddress("eglQueryDeviceStringEXT"));
    attribute = reinterpret_cast<PFNEGLQUERYDEVICEATTRIBEXTPROC>(
        eglGetProcAddress("eglQueryDeviceAttribEXT"));
  }

  std::vector<EGLDeviceEXT> list() const {
    EGLint count = 0;
    if (devices == nullptr || text == nullptr || attribute == nullptr) return {};
    if (devices(0, nullptr, &count) != EGL_TRUE || count <= 0) return {};
    std::vector<EGLDeviceEXT> result(static_cast<std::size_t>(count));
    if (devices(count, result.data(), &count) != EGL_TRUE) return {};
    result.resize(static_cast<std::size_t>(std::max(count, 0)));
    return result;
  }
};

EglDeviceInfo describe(const DeviceFunctions& functions, EGLDeviceEXT device, int index) {
  EglDeviceInfo info;
  info.index = index;
  if (functions.text == nullptr || functions.attribute == nullptr) return info;
  const char* extensions = functions.text(device, EGL_EXTENSIONS);
  info.extensions = extensions == nullptr ? "" : extensions;
  info.software = hasWord(extensions, "EGL_MESA_device_software");
  if (hasWord(extensions, "EGL_EXT_device_drm")) {
    const char* file = functions.text(device, EGL_DRM_DEVICE_FILE_EXT);
    info.drm_file = file == nullptr ? "" : file;
  }
  if (hasWord(extensions, "EGL_NV_device_cuda")) {
    EGLAttrib cuda = -1;
    if (functions.attribute(device, EGL_CUDA_DEVICE_NV, &cuda) == EGL_TRUE) {
      info.cuda_device = static_cast<int>(cuda);
    }
  }
  return info;
}

DisplaySource sourceOf(EGLDeviceEXT device, const EglDeviceInfo& info) {
  return {EGL_PLATFORM_DEVICE_EXT, device, "device " + std::to_string(info.index), info.software};
}

}  // namespace

bool hasWord(const char* list, const char* name) {
  if (list == nullptr) return false;
  const std::size_t length = std::strlen(name);
  for (const char* at = std::strstr(list, name); at != nullptr; at = std::strstr(at + 1, name)) {
    const bool begins = at == list || at[-1] == ' ';
    if (begins && (at[length] == ' ' || at[length] == '\0')) return true;
  }
  return false;
}

std::string eglErrorName(EGLint error) {
  switch (error) {
    case EGL_NOT_INITIALIZED:
      return "EGL_NOT_INITIALIZED";
    case EGL_BAD_ALLOC:
      return "EGL_BAD_ALLOC";
    case EGL_BAD_ATTRIBUTE:
      return "EGL_BAD_ATTRIBUTE";
    case EGL_BAD_CONFIG:
      return "EGL_BAD_CONFIG";
    case EGL_BAD_MATCH:
      return "EGL_BAD_MATCH";
    case EGL_BAD_PARAMETER:
      return "EGL_BAD_PARAMETER";
    case EGL_SUCCESS:
      return "no driver answers";
    default: {
      char text[16];
      std::snprintf(text, sizeof text, "0x%04x", static_cast<unsigned>(error));
      return text;
    }
  }
}

std::vector<EglDeviceInfo> listEglDevices() {
  const DeviceFunctions functions;
  std::vector<EglDeviceInfo> result;
  int index = 0;
  for (const EGLDeviceEXT device : functions.list()) {
    EglDeviceInfo info = describe(functions, device, index);
    try {
      const Display display(sourceOf(device, info));
      const char* vendor = eglQueryString(display.get(), EGL_VENDOR);
      info.vendor = vendor == nullptr ? "" : vendor;
    } catch (const Unavailable&) {
      // A device that does not start is listed without a vendor.
      info.vendor.clear();
    }
    result.push_back(std::move(info));
    ++index;
  }
  return result;
}

std::vector<DisplaySource> displaySources(int cuda_device) {
  const DeviceFunctions functions;
  std::vector<std::pair<int, DisplaySource>> ranked;
  int index = 0;
  for (const EGLDeviceEXT device : functions.list()) {
    const EglDeviceInfo info = describe(functions, device, index);
    const bool wanted = cuda_device >= 0 && info.cuda_device == cuda_device;
    const int rank = wanted ? 0 : (info.software ? 2 : 1);
    ranked.emplace_back(rank, sourceOf(device, info));
    ++index;
  }
  std::stable_sort(
      ranked.begin(), ranked.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<DisplaySource> result;
  result.reserve(ranked.size() + 2);
  for (auto& [rank, source] : ranked) result.push_back(std::move(source));
  const char* client = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
  if (hasWord(client, "EGL_MESA_platform_surfaceless")) {
    result.push_back({EGL_PLATFORM_SURFACELESS_MESA, nullptr, "surfaceless", false});
  }
  result.push_back({0, nullptr, "default", false});
  return result;
}

Display::Display(const DisplaySource& source) {
  const char* client = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
  // Two contexts of one process get the same display. Without reference counting the first to go
  // would terminate it for the other, so then it is never terminated.
  referenced_ = source.platform != 0 && hasWord(client, "EGL_KHR_display_reference");
  const EGLAttrib counted[] = {EGL_TRACK_REFERENCES_KHR, EGL_TRUE, EGL_NONE};
  const EGLAttrib plain[] = {EGL_NONE};
  if (source.platform == 0) {
    display_ = eglGetDisplay(EGL_DEFAULT_DISPLAY);
  } else {
    display_ = eglGetPlatformDisplay(source.platform, source.native, referenced_ ? counted : plain);
  }
  if (display_ == EGL_NO_DISPLAY) {
    throw Unavailable(source.name + ": no display (" + eglErrorName(eglGetError()) + ")");
  }
  if (eglInitialize(display_, nullptr, nullptr) != EGL_TRUE) {
    throw Unavailable(source.name + ": does not start (" + eglErrorName(eglGetError()) + ")");
  }
}

Display::Display(Display&& other) noexcept
    : display_(std::exchange(other.display_, EGL_NO_DISPLAY)), referenced_(other.referenced_) {}

Display& Display::operator=(Display&& other) noexcept {
  std::swap(display_, other.display_);
  std::swap(referenced_, other.referenced_);
  return *this;
}

Display::~Display() {
  if (display_ != EGL_NO_DISPLAY && referenced_) eglTerminate(display_);
}

bool Display::has(const char* extension) const {
  return hasWord(eglQueryString(display_, EGL_EXTENSIONS), extension);
}

}  // namespace rangepose::gles
