// EGL displays without a screen: which ones this machine may have, and one that is open.
#pragma once

#include <string>
#include <vector>

#include "gles/gl.h"

namespace rangepose::gles {

/// What EGL tells about one of its devices, for `rangepose doctor`.
struct EglDeviceInfo {
  int index = 0;
  std::string vendor;      ///< of its driver, empty when it does not start
  std::string extensions;  ///< of the device, space separated
  std::string drm_file;    ///< e.g. /dev/dri/card0, empty if none
  int cuda_device = -1;    ///< EGL_CUDA_DEVICE_NV, -1 if none
  bool software = false;   ///< EGL_MESA_device_software
};

/// All devices of EGL_EXT_platform_device; empty when there is no EGL driver.
std::vector<EglDeviceInfo> listEglDevices();

/// A display that may be opened.
struct DisplaySource {
  EGLenum platform = 0;    ///< 0: the default display
  void* native = nullptr;  ///< the EGL device, where there is one
  std::string name;        ///< e.g. "device 0", "surfaceless"
  bool software = false;   ///< known to be a software rasteriser before it is opened
};

/// Hardware devices first (`cuda_device` >= 0: the one with this EGL_CUDA_DEVICE_NV before all
/// others), then software ones, then Mesa's surfaceless platform, then the default display.
std::vector<DisplaySource> displaySources(int cuda_device);

/// An initialised display.
class Display {
 public:
  /// Throws Unavailable with the reason.
  explicit Display(const DisplaySource& source);
  Display(Display&& other) noexcept;
  Display& operator=(Display&& other) noexcept;
  Display(const Display&) = delete;
  Display& operator=(const Display&) = delete;
  ~Display();

  EGLDisplay get() const { return display_; }
  bool has(const char* extension) const;

 private:
  EGLDisplay display_ = EGL_NO_DISPLAY;
  bool referenced_ = false;  ///< the display counts its users, so it may be terminated
};

/// Whether `name` is one of the words of `list`.
bool hasWord(const char* list, const char* name);

/// Name of an EGL error code.
std::string eglErrorName(EGLint error);

}  // namespace rangepose::gles
