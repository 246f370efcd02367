// What a pass draws into.
#pragma once

#include "gles/texture.h"

namespace rangepose::gles {

/// The textures must outlive it.
class Framebuffer {
 public:
  /// Throws Error when the driver cannot draw into this combination.
  explicit Framebuffer(const Texture& color, const Texture* depth = nullptr);
  /// Binds it and sets the viewport to the whole of it.
  void bind() const;
  /// Sets all texels of a float target (all rows, all channels).
  void clear(const glm::vec4& value) const;
  /// Sets all texels of the depth buffer to the far end.
  void clearDepth() const;
  int width() const { return width_; }
  int height() const { return height_; }

 private:
  FramebufferHandle handle_;
  int width_;
  int height_;
};

/// A texture that is drawn into and read from.
struct Canvas {
  Canvas(Format format, int width, int height)
      : texture(format, width, height), framebuffer(texture) {}
  Texture texture;
  Framebuffer framebuffer;
};

}  // namespace rangepose::gles
