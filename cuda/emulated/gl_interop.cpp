// Textures that GL shares with the emulated device: read from GL when they are mapped, and written
// back when they are unmapped.
#include <cstdint>
#include <vector>

#include "cuda/emulated/runtime.h"
#include "gles/gl.h"

struct cudaGraphicsResource {
  GLuint texture;
  rangepose::cuda::emulated::TexelKind kind;
  int width;
  int height;
  cudaArray_t mapped;  ///< null while it is not
};

namespace rangepose::cuda::emulated {
namespace {

struct Transfer {
  GLenum format;
  GLenum type;
};

Transfer transferOf(TexelKind kind) {
  switch (kind) {
    case TexelKind::kFloat4:
      return {GL_RGBA, GL_FLOAT};
    case TexelKind::kInt:
      return {GL_RED_INTEGER, GL_INT};
    case TexelKind::kFloat:
      break;
  }
  return {GL_RED, GL_FLOAT};
}

/// Leaves what is bound as it was.
class BoundTexture {
 public:
  explicit BoundTexture(GLuint texture) {
    glGetIntegerv(GL_TEXTURE_BINDING_2D, &before_);
    glBindTexture(GL_TEXTURE_2D, texture);
  }
  ~BoundTexture() { glBindTexture(GL_TEXTURE_2D, static_cast<GLuint>(before_)); }

 private:
  GLint before_ = 0;
};

class ReadFramebuffer {
 public:
  explicit ReadFramebuffer(GLuint texture) {
    glGetIntegerv(GL_READ_FRAMEBUFFER_BINDING, &before_);
    glGenFramebuffers(1, &own_);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, own_);
    glFramebufferTexture2D(GL_READ_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture, 0);
  }
  ~ReadFramebuffer() {
    glBindFramebuffer(GL_READ_FRAMEBUFFER, static_cast<GLuint>(before_));
    glDeleteFramebuffers(1, &own_);
  }

 private:
  GLint before_ = 0;
  GLuint own_ = 0;
};

void readFromGl(const cudaGraphicsResource& resource) {
  const ReadFramebuffer framebuffer(resource.texture);
  const Transfer transfer = transferOf(resource.kind);
  const OpenMemory open;
  glReadPixels(0,
               0,
               resource.width,
               resource.height,
               transfer.format,
               transfer.type,
               texelsOf(resource.mapped));
  glFinish();
}

void writeToGl(const cudaGraphicsResource& resource) {
  const BoundTexture bound(resource.texture);
  const Transfer transfer = transferOf(resource.kind);
  const OpenMemory open;
  glTexSubImage2D(GL_TEXTURE_2D,
                  0,
                  0,
                  0,
                  resource.width,
                  resource.height,
                  transfer.format,
                  transfer.type,
                  texelsOf(resource.mapped));
  glFinish();
}

}  // namespace
}  // namespace rangepose::cuda::emulated

using namespace rangepose::cuda::emulated;

extern "C" cudaError_t CUDARTAPI cudaGraphicsGLRegisterImage(cudaGraphicsResource_t* resource,
                                                             GLuint image,
                                                             GLenum target,
                                                             unsigned int /*flags*/) {
  const Call call("cudaGraphicsGLRegisterImage");
  if (call.injected()) return remembered(*call.injected());
  if (target != GL_TEXTURE_2D || glIsTexture(image) == GL_FALSE) {
    return remembered(cudaErrorInvalidValue);
  }
  GLint format = 0;
  GLint width = 0;
  GLint height = 0;
  {
    const BoundTexture bound(image);
    glGetTexLevelParameteriv(GL_TEXTURE_2D, 0, GL_TEXTURE_INTERNAL_FORMAT, &format);
    glGetTexLevelParameteriv(GL_TEXTURE_2D, 0, GL_TEXTURE_WIDTH, &width);
    glGetTexLevelParameteriv(GL_TEXTURE_2D, 0, GL_TEXTURE_HEIGHT, &height);
  }
  if (width <= 0 || height <= 0) return remembered(cudaErrorInvalidValue);
  switch (format) {
    case GL_R32F:
      *resource = new cudaGraphicsResource{image, TexelKind::kFloat, width, height, nullptr};
      break;
    case GL_RGBA32F:
      *resource = new cudaGraphicsResource{image, TexelKind::kFloat4, width, height, nullptr};
      break;
    case GL_R32I:
      *resource = new cudaGraphicsResource{image, TexelKind::kInt, width, height, nullptr};
      break;
    default:
      return remembered(cudaErrorInvalidValue);
  }
  ++counts().resources;
  return cudaSuccess;
}

cudaError_t cudaGraphicsUnregisterResource(cudaGraphicsResource_t resource) {
  const Call call("cudaGraphicsUnregisterResource");
  if (call.injected()) return remembered(*call.injected());
  if (resource->mapped != nullptr) return remembered(cudaErrorUnknown);
  delete resource;
  --counts().resources;
  return cudaSuccess;
}

cudaError_t cudaGraphicsMapResources(int count,
                                     cudaGraphicsResource_t* resources,
                                     cudaStream_t stream) {
  const Call call("cudaGraphicsMapResources");
  if (call.injected()) return remembered(*call.injected());
  for (int i = 0; i < count; ++i) {
    if (resources[i]->mapped != nullptr) return remembered(cudaErrorUnknown);
  }
  static_cast<void>(stream);
  for (int i = 0; i < count; ++i) {
    cudaGraphicsResource& resource = *resources[i];
    resource.mapped = makeArray(resource.kind, resource.width, resource.height);
    if (resource.mapped == nullptr) return remembered(cudaErrorMemoryAllocation);
    readFromGl(resource);
  }
  return cudaSuccess;
}

cudaError_t cudaGraphicsUnmapResources(int count,
                                       cudaGraphicsResource_t* resources,
                                       cudaStream_t stream) {
  const Call call("cudaGraphicsUnmapResources");
  if (call.injected()) return remembered(*call.injected());
  for (int i = 0; i < count; ++i) {
    if (resources[i]->mapped == nullptr) return remembered(cudaErrorUnknown);
  }
  const cudaError_t result = drain(stream);
  for (int i = 0; i < count; ++i) {
    writeToGl(*resources[i]);
    dropArray(resources[i]->mapped);
    resources[i]->mapped = nullptr;
  }
  return remembered(result);
}

cudaError_t cudaGraphicsSubResourceGetMappedArray(cudaArray_t* array,
                                                  cudaGraphicsResource_t resource,
                                                  unsigned index,
                                                  unsigned level) {
  const Call call("cudaGraphicsSubResourceGetMappedArray");
  if (call.injected()) return remembered(*call.injected());
  if (resource->mapped == nullptr || index != 0 || level != 0) {
    return remembered(cudaErrorUnknown);
  }
  *array = resource->mapped;
  return cudaSuccess;
}
