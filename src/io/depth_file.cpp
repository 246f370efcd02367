#include "io/depth_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "io/atomic_file.h"
#include "io/camera_file.h"
#include "io/depth_formats.h"
#include "io/file_bytes.h"

namespace rangepose {
namespace {

constexpr std::uintmax_t kMaxImageBytes = std::uintmax_t{1} << 30;

Image<float> decodeDepth(std::string_view bytes, const std::string& where) {
  using namespace std::string_view_literals;
  if (bytes.starts_with("\x89PNG\r\n\x1a\n"sv)) return decodeDepthPng(bytes, where);
  if (bytes.starts_with("II*\0"sv) || bytes.starts_with("MM\0*"sv) ||
      bytes.starts_with("II+\0"sv) || bytes.starts_with("MM\0+"sv)) {
    return decodeDepthTiff(bytes, where);
  }
  if (bytes.starts_with("\x76\x2f\x31\x01"sv)) return decodeDepthExr(bytes, where);
  throw Error(where + ": neither PNG, TIFF nor EXR; give a 16-bit or float depth image");
}

}  // namespace

void checkImageSize(std::int64_t width, std::int64_t height, const std::string& where) {
  if (width > 0 && height > 0 && width <= kMaxImagePixels && height <= kMaxImagePixels / width) {
    return;
  }
  throw Error(fmt::format("{}: the image size {}x{} is not supported; give 1 to {} pixels",
                          where,
                          width,
                          height,
                          kMaxImagePixels));
}

DepthImage readDepth(const std::filesystem::path& path, const Camera& camera) {
  const std::string where = fileLabel("depth image", path);
  const std::string bytes = readFileBytes(path, "depth image", kMaxImageBytes);
  DepthImage image;
  image.depth_mm = decodeDepth(bytes, where);
  image.camera = withImageSize(camera, image.depth_mm.width(), image.depth_mm.height(), where);
  for (float& depth : image.depth_mm) {
    const auto depth_mm = static_cast<float>(depth * camera.depth_scale);
    depth = std::isfinite(depth_mm) && depth_mm > 0.0f ? depth_mm : 0.0f;
  }
  return image;
}

int validPixels(const DepthImage& image) {
  return static_cast<int>(std::count_if(image.depth_mm.begin(),
                                        image.depth_mm.end(),
                                        [](float depth_mm) { return depth_mm > 0.0f; }));
}

void writeDepthPng(const std::filesystem::path& path, const DepthImage& image) {
  const std::string where = fileLabel("depth image", path);
  const Image<float>& depth_mm = image.depth_mm;
  checkImageSize(depth_mm.width(), depth_mm.height(), where);
  RP_CHECK(image.camera.depth_scale > 0.0, where + ": depth_scale must be positive");
  Image<std::uint16_t> values(depth_mm.width(), depth_mm.height());
  for (int y = 0; y < depth_mm.height(); ++y) {
    for (int x = 0; x < depth_mm.width(); ++x) {
      const double value = std::round(depth_mm.at(x, y) / image.camera.depth_scale);
      if (!(value >= 0.0 && value <= 65535.0)) {
        throw Error(
            fmt::format("{}: pixel ({}, {}) has {} mm, which does not fit into 16 bits at a "
                        "depth_scale of {}; use a larger one",
                        where,
                        x,
                        y,
                        depth_mm.at(x, y),
                        image.camera.depth_scale));
      }
      values.at(x, y) = static_cast<std::uint16_t>(value);
    }
  }
  writeFileAtomically(path, encodeDepthPng(values));
}

}  // namespace rangepose
