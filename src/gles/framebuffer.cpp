#include "gles/framebuffer.h"

#include "core/error.h"

namespace rangepose::gles {

Framebuffer::Framebuffer(const Texture& color, const Texture* depth)
    : width_(color.width()), height_(color.height()) {
  GLuint name = 0;
  glGenFramebuffers(1, &name);
  handle_ = FramebufferHandle(name);
  glBindFramebuffer(GL_FRAMEBUFFER, name);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, color.id(), 0);
  if (depth != nullptr) {
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, depth->id(), 0);
  }
  RP_CHECK(glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE,
           "framebuffer of " + std::to_string(width_) + "x" + std::to_string(height_) +
               " px is not complete: the driver cannot draw into this format");
}

void Framebuffer::bind() const {
  glBindFramebuffer(GL_FRAMEBUFFER, handle_.id());
  glViewport(0, 0, width_, height_);
}

void Framebuffer::clear(const glm::vec4& value) const {
  bind();
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glClearBufferfv(GL_COLOR, 0, &value.x);
}

void Framebuffer::clearDepth() const {
  bind();
  const float far = 1.0f;
  glDepthMask(GL_TRUE);
  glClearBufferfv(GL_DEPTH, 0, &far);
}

}  // namespace rangepose::gles
