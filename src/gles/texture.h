// A two-dimensional texture of one level, nearest sampling.
#pragma once

#include <cstdint>

#include "core/image.h"
#include "gles/handle.h"
#include "stages/reference.h"
#include "stages/scene_channels.h"

namespace rangepose::gles {

enum class Format {
  kRgba32f,   ///< Image<glm::vec4>, Image<EdtTexel>
  kRg32f,     ///< neither uploaded nor downloaded
  kR32f,      ///< Image<float>
  kR32i,      ///< Image<std::int32_t>
  kDepth32f,  ///< depth buffer: neither uploaded nor downloaded
};

/// Row y of an image is row y of the texture: nothing is flipped anywhere.
class Texture {
 public:
  /// Content undefined.
  Texture(Format format, int width, int height);
  explicit Texture(const Image<glm::vec4>& image);
  explicit Texture(const Image<float>& image);

  int width() const { return width_; }
  int height() const { return height_; }
  Format format() const { return format_; }
  GLuint id() const { return handle_.id(); }

  /// `texels`: width * height texels of the format, row by row.
  void upload(const void* texels);
  void downloadFloats(Image<float>& into) const;
  Image<float> downloadFloats() const;
  Image<std::int32_t> downloadInts() const;
  /// `count` rows from row `y` on, 4 floats a texel.
  void downloadRgba(int y, int count, float* into) const;

 private:
  Format format_;
  int width_;
  int height_;
  TextureHandle handle_;
};

Image<glm::vec4> downloadVectors(const Texture& texture);
Image<EdtTexel> downloadEdt(const Texture& texture);

}  // namespace rangepose::gles
