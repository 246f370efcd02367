#include "gles/texture.h"

#include <string>
#include <vector>

#include "core/error.h"
#include "gles/framebuffer.h"

namespace rangepose::gles {
namespace {

static_assert(sizeof(EdtTexel) == 4 * sizeof(float) && sizeof(glm::vec4) == 4 * sizeof(float));

struct GlFormat {
  GLenum internal;
  GLenum layout;
  GLenum type;
};

GlFormat glFormat(Format format) {
  switch (format) {
    case Format::kRgba32f:
      return {GL_RGBA32F, GL_RGBA, GL_FLOAT};
    case Format::kRg32f:
      return {GL_RG32F, GL_RG, GL_FLOAT};
    case Format::kR32f:
      return {GL_R32F, GL_RED, GL_FLOAT};
    case Format::kR32i:
      return {GL_R32I, GL_RED_INTEGER, GL_INT};
    case Format::kDepth32f:
      return {GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT, GL_FLOAT};
  }
  throw Error("texture: unknown format");
}

/// Whether glReadPixels gives one channel of the bound framebuffer directly; four it always gives.
bool readsOneChannel(GLenum layout, GLenum type) {
  GLint read_layout = 0;
  GLint read_type = 0;
  glGetIntegerv(GL_IMPLEMENTATION_COLOR_READ_FORMAT, &read_layout);
  glGetIntegerv(GL_IMPLEMENTATION_COLOR_READ_TYPE, &read_type);
  return static_cast<GLenum>(read_layout) == layout && static_cast<GLenum>(read_type) == type;
}

template <typename T>
void downloadOneChannel(
    const Texture& texture, GLenum one, GLenum four, GLenum type, Image<T>& into) {
  const Framebuffer framebuffer(texture);
  framebuffer.bind();
  if (into.width() != texture.width() || into.height() != texture.height()) {
    into = Image<T>(texture.width(), texture.height());
  }
  if (readsOneChannel(one, type)) {
    glReadPixels(0, 0, texture.width(), texture.height(), one, type, into.data());
    return;
  }
  std::vector<T> texels(into.size() * 4);
  glReadPixels(0, 0, texture.width(), texture.height(), four, type, texels.data());
  for (std::size_t i = 0; i < into.size(); ++i) into.data()[i] = texels[4 * i];
}

}  // namespace

Texture::Texture(Format format, int width, int height)
    : format_(format), width_(width), height_(height) {
  GLint limit = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &limit);
  RP_CHECK(width > 0 && height > 0 && width <= limit && height <= limit,
           "texture of " + std::to_string(width) + "x" + std::to_string(height) +
               " px: this driver allows 1.." + std::to_string(limit) + " px a side");
  GLuint name = 0;
  glGenTextures(1, &name);
  handle_ = TextureHandle(name);
  glBindTexture(GL_TEXTURE_2D, name);
  glTexStorage2D(GL_TEXTURE_2D, 1, glFormat(format).internal, width, height);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
}

Texture::Texture(const Image<glm::vec4>& image)
    : Texture(Format::kRgba32f, image.width(), image.height()) {
  upload(image.data());
}

Texture::Texture(const Image<float>& image)
    : Texture(Format::kR32f, image.width(), image.height()) {
  upload(image.data());
}

void Texture::upload(const void* texels) {
  const GlFormat format = glFormat(format_);
  glBindTexture(GL_TEXTURE_2D, id());
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, width_, height_, format.layout, format.type, texels);
}

void Texture::downloadFloats(Image<float>& into) const {
  RP_CHECK(format_ == Format::kR32f, "texture: downloadFloats needs the format R32F");
  downloadOneChannel(*this, GL_RED, GL_RGBA, GL_FLOAT, into);
}

Image<float> Texture::downloadFloats() const {
  Image<float> image;
  downloadFloats(image);
  return image;
}

Image<std::int32_t> Texture::downloadInts() const {
  RP_CHECK(format_ == Format::kR32i, "texture: downloadInts needs the format R32I");
  Image<std::int32_t> image;
  downloadOneChannel(*this, GL_RED_INTEGER, GL_RGBA_INTEGER, GL_INT, image);
  return image;
}

void Texture::downloadRgba(int y, int count, float* into) const {
  RP_CHECK(format_ == Format::kRgba32f && y >= 0 && count >= 0 && y + count <= height_,
           "texture: downloadRgba needs the format RGBA32F and rows inside of the texture");
  const Framebuffer framebuffer(*this);
  framebuffer.bind();
  glReadPixels(0, y, width_, count, GL_RGBA, GL_FLOAT, into);
}

Image<glm::vec4> downloadVectors(const Texture& texture) {
  Image<glm::vec4> image(texture.width(), texture.height());
  texture.downloadRgba(0, texture.height(), &image.data()->x);
  return image;
}

Image<EdtTexel> downloadEdt(const Texture& texture) {
  Image<EdtTexel> image(texture.width(), texture.height());
  texture.downloadRgba(0, texture.height(), &image.data()->site_x);
  return image;
}

}  // namespace rangepose::gles
