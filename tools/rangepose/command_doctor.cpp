// rangepose doctor: what this machine offers, and which paths work.
#include <dlfcn.h>
#include <fmt/format.h>

#include <algorithm>
#include <iostream>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "core/error.h"
#include "gles/context.h"
#include "gles/egl_display.h"
#include "gles/stage_set_gles.h"
#include "rangepose/command.h"
#include "rangepose/cuda_options.h"

namespace rangepose::cli {
namespace {

constexpr const char* kExamples = R"(Examples:
  rangepose doctor
  rangepose doctor --interop copy                                  whether CUDA works without shared textures
  __EGL_VENDOR_LIBRARY_FILENAMES=/nonexistent rangepose doctor     as if there were no EGL driver)";

/// What of CUDA works here.
struct CudaFindings {
  cuda::Status status;
  std::string interop;  ///< in use, and why others are not; empty: the path does not open
  std::string failure;  ///< why it does not open; empty: it does
  std::string left_to_host;
};

CudaFindings findCuda(const cuda::PathOptions& options) {
  CudaFindings found;
  found.status = cuda::status();
  try {
    const cuda::Path path = cuda::openPath(options);
    found.interop = std::string(cuda::nameOf(path.interop)) + ": " + path.interop_note;
    found.left_to_host = path.stages->left_to_host;
  } catch (const Error& error) {
    found.failure = error.what();
  }
  return found;
}

/// Where the program knows nothing of CUDA, whether its driver is there at all.
bool hasNvidiaDriver() {
  void* const library = dlopen("libcuda.so.1", RTLD_LAZY | RTLD_LOCAL);
  if (library == nullptr) return false;
  dlclose(library);
  return true;
}

const char* simdName() {
#if defined(__x86_64__) && defined(__GNUC__)
  return __builtin_cpu_supports("avx2") != 0 ? "AVX2" : "SSE2 (no AVX2: the search is slower)";
#elif defined(__aarch64__)
  return "NEON";
#else
  return "what the compiler makes of it";
#endif
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : " ") + word;
  return text.empty() ? "none" : text;
}

void row(const char* name, const std::string& value) {
  std::cout << fmt::format("  {:<18}{}\n", name, value);
}

void printHost() {
  const unsigned cores = std::max(1U, std::thread::hardware_concurrency());
  std::cout << "host\n";
  row("cores", std::to_string(cores));
#ifdef RP_HAVE_TBB
  row("threads", fmt::format("{} (oneTBB; --threads sets fewer)", cores));
#else
  row("threads", fmt::format("{} (standard library; --threads sets fewer)", cores));
#endif
  row("SIMD", simdName());
}

void printEglDevices(const std::vector<gles::EglDeviceInfo>& devices) {
  std::cout << "EGL devices\n";
  if (devices.empty()) std::cout << "  none\n";
  for (const gles::EglDeviceInfo& device : devices) {
    std::string text = device.vendor.empty() ? "does not start" : device.vendor;
    text += device.software ? ", software" : ", hardware";
    if (!device.drm_file.empty()) text += ", " + device.drm_file;
    if (device.cuda_device >= 0) text += fmt::format(", CUDA device {}", device.cuda_device);
    row(fmt::format("device {}", device.index).c_str(), text);
  }
}

void printContext(const gles::ContextInfo& info) {
  std::cout << "GL\n";
  row("context", "EGL " + info.platform);
  row("renderer", info.renderer + (info.software ? " (software)" : " (hardware)"));
  row("vendor", info.vendor);
  row("version", info.version);
  row("GLSL", info.glsl_version);
  row("float targets", "RGBA32F and R32F can be rendered to");
  row("extensions", joined(info.extensions));
  row("not there", joined(info.missing));
  row("largest texture", fmt::format("{} px", info.max_texture_size));
}

void printCuda(const CudaFindings& found) {
  const cuda::Status& status = found.status;
  std::cout << "CUDA\n";
  row("cuda",
      status.toolkit.empty() ? "not built in"
      : status.emulated      ? "built for a device that the host emulates: for tests"
                             : "built with CUDA " + status.toolkit);
  std::string driver = hasNvidiaDriver() ? "found (libcuda.so.1)" : "not found (libcuda.so.1)";
  if (!status.driver.empty()) driver += ", up to CUDA " + status.driver;
  row("NVIDIA driver", driver);
  for (const cuda::DeviceInfo& device : status.devices) {
    row(fmt::format("CUDA device {}", device.index).c_str(),
        fmt::format("{}, compute capability {}.{}, {} multiprocessors, {:.0f} MB",
                    device.name,
                    device.capability / 10,
                    device.capability % 10,
                    device.multiprocessors,
                    device.memory_mb));
  }
  if (!found.interop.empty()) row("interop", found.interop);
}

/// Unavailable begins with the name of the path.
std::string withoutPath(const std::string& failure) {
  const std::string prefix = "path cuda: ";
  return failure.rfind(prefix, 0) == 0 ? failure.substr(prefix.size()) : failure;
}

/// One line for each thing that is missing, with what it needs.
void printMissing(const std::string& no_context,
                  const gles::ContextInfo* info,
                  const std::vector<gles::EglDeviceInfo>& devices,
                  const CudaFindings& cuda) {
  std::vector<std::string> lines;
  if (info == nullptr) lines.push_back("glsl: " + no_context);
  for (const std::string& name : info != nullptr ? info->missing : std::vector<std::string>()) {
    lines.push_back("glsl: " + name +
                    " (not required): comes with a newer driver, e.g. libgl1-mesa-dri");
  }
  const bool nvidia_egl = std::any_of(
      devices.begin(), devices.end(), [](const auto& device) { return device.cuda_device >= 0; });
  if (hasNvidiaDriver() && !nvidia_egl) {
    lines.emplace_back(
        "glsl on the NVIDIA GPU: its EGL driver is not there; install libnvidia-egl-gbm1 or the "
        "libnvidia-gl "
        "package of the driver's version (in a container: NVIDIA_DRIVER_CAPABILITIES=all)");
  } else if (info != nullptr && info->software) {
    lines.emplace_back(
        "glsl on a GPU: needs a GPU and its driver (Mesa: libgl1-mesa-dri; NVIDIA: libnvidia-gl)");
  }
  if (!cuda.failure.empty()) lines.push_back("cuda: " + withoutPath(cuda.failure));
  std::cout << "missing\n";
  for (const std::string& line : lines) std::cout << "  " << line << '\n';
}

/// What a path that works leaves to the host.
std::string withRest(const std::string& works, const std::string& left_to_host) {
  return left_to_host.empty() ? works : works + "; the host does its " + left_to_host;
}

void printPaths(const gles::ContextInfo* info, const CudaFindings& cuda) {
  std::cout << "paths\n";
  row("host", "yes");
  row("glsl",
      info == nullptr
          ? "no"
          : withRest(info->software ? "yes, in software: slow" : "yes", gles::kLeftToHost));
  row("cuda",
      !cuda.failure.empty()
          ? "no"
          : withRest(cuda.status.emulated ? "yes, emulated: for tests" : "yes", cuda.left_to_host));
  const bool gpu = info != nullptr && !info->software;
  row("--path auto",
      fmt::format("takes {}; build renders by host",
                  cuda.failure.empty() && !cuda.status.emulated ? "cuda"
                  : gpu                                         ? "glsl"
                                                                : "host"));
}

int examine(const CudaArguments& arguments) {
  const std::vector<gles::EglDeviceInfo> devices = gles::listEglDevices();
  std::unique_ptr<gles::Context> context;
  std::string no_context;
  try {
    context = std::make_unique<gles::Context>();
  } catch (const Unavailable& error) {
    no_context = error.what();
  }
  const gles::ContextInfo* const info = context != nullptr ? &context->info() : nullptr;
  const CudaFindings cuda = findCuda(cudaOptions(arguments));
  std::cout << "rangepose " RP_VERSION "\n";
  printHost();
  printEglDevices(devices);
  if (info != nullptr) printContext(*info);
  if (info == nullptr) std::cout << "GL\n  none\n";
  printCuda(cuda);
  printPaths(info, cuda);
  printMissing(no_context, info, devices, cuda);
  return kDone;
}

}  // namespace

std::function<int()> declareDoctor(CLI::App& command) {
  const auto arguments = std::make_shared<CudaArguments>();
  command.footer(kExamples);
  declareInterop(command, *arguments);
  return [arguments] { return examine(*arguments); };
}

}  // namespace rangepose::cli
