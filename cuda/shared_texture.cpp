#include "cuda/shared_texture.h"

#include <algorithm>
#include <utility>

#include "core/error.h"
#include "cuda/check.h"
#include "cuda/stream.h"
#include "gles/framebuffer.h"

// From cuda_gl_interop.h, which includes GL/gl.h: a machine with GLES alone does not have that.
extern "C" cudaError_t CUDARTAPI cudaGraphicsGLRegisterImage(cudaGraphicsResource_t* resource,
                                                             GLuint image,
                                                             GLenum target,
                                                             unsigned int flags);

namespace rangepose::cuda {
namespace {

/// Of one texture: a frame that maps it again and again waits once in so many times.
constexpr std::size_t kMostPast = 8;

gles::Format formatOf(Element element) {
  switch (element) {
    case Element::kFloat:
      return gles::Format::kR32f;
    case Element::kFloat4:
      return gles::Format::kRgba32f;
    case Element::kInt:
      return gles::Format::kR32i;
  }
  throw Error("shared texture: unknown element");
}

}  // namespace

class SharedTexture::Registration {
 public:
  Registration(Element kind, int width, int height)
      : element(kind), texture(formatOf(kind), width, height) {
    past.reserve(kMostPast);
    RP_CUDA(cudaGraphicsGLRegisterImage(
        &resource, texture.id(), GL_TEXTURE_2D, cudaGraphicsRegisterFlagsSurfaceLoadStore));
  }
  Registration(const Registration&) = delete;
  Registration& operator=(const Registration&) = delete;
  ~Registration() {
    if (resource == nullptr) return;
    // Kernels that use it may still be queued. In whichever stream: that may be gone.
    cudaDeviceSynchronize();
    past.clear();
    cudaGraphicsUnregisterResource(resource);
  }

  Element element;
  gles::Texture texture;
  cudaGraphicsResource_t resource = nullptr;
  bool mapped = false;
  /// Of mappings that are over, but not for the kernels that are queued with them.
  std::vector<ArrayAccess> past;
};

SharedTexture::SharedTexture(Element element, int width, int height)
    : registration_(std::make_shared<Registration>(element, width, height)) {}

const gles::Texture& SharedTexture::texture() const {
  RP_CHECK(!registration_->mapped, "shared texture: GL asked for it while CUDA has it mapped");
  return registration_->texture;
}

Element SharedTexture::element() const { return registration_->element; }

MappedTextures::MappedTextures(const std::vector<const SharedTexture*>& textures,
                               cudaStream_t stream)
    : stream_(stream) {
  for (const SharedTexture* texture : textures) {
    const std::shared_ptr<SharedTexture::Registration>& registration = texture->registration_;
    const bool twice = std::find(registrations_.begin(), registrations_.end(), registration) !=
                       registrations_.end();
    RP_CHECK(!registration->mapped && !twice, "shared texture: mapped twice at a time");
    registrations_.push_back(registration);
    resources_.push_back(registration->resource);
  }
  if (resources_.empty()) return;
  RP_CUDA(
      cudaGraphicsMapResources(static_cast<int>(resources_.size()), resources_.data(), stream_));
  for (const auto& registration : registrations_) registration->mapped = true;
  try {
    for (const auto& registration : registrations_) {
      cudaArray_t array = nullptr;
      RP_CUDA(cudaGraphicsSubResourceGetMappedArray(&array, registration->resource, 0, 0));
      arrays_.push_back(array);
      access_.emplace_back(array, registration->texture.width(), registration->texture.height());
    }
  } catch (...) {
    unmap();
    throw;
  }
}

MappedTextures::~MappedTextures() { unmap(); }

void MappedTextures::unmap() noexcept {
  if (resources_.empty()) return;
  for (std::size_t i = 0; i < access_.size(); ++i) retire(i);
  access_.clear();
  cudaGraphicsUnmapResources(static_cast<int>(resources_.size()), resources_.data(), stream_);
  for (const auto& registration : registrations_) registration->mapped = false;
}

void MappedTextures::retire(std::size_t index) noexcept {
  std::vector<ArrayAccess>& past = registrations_[index]->past;
  if (past.size() >= kMostPast) {
    cudaStreamSynchronize(stream_);
    past.clear();
  }
  past.push_back(std::move(access_[index]));
}

void requireSharing() {
  constexpr float kDrawn = 1.5f;
  constexpr float kWritten = 2.5f;
  const SharedTexture shared(Element::kFloat, 2, 2);
  const Stream stream;
  gles::Framebuffer(shared.texture()).clear(glm::vec4(kDrawn));
  float pixels[4] = {};
  const Landing landing(stream.get());
  {
    const MappedTextures mapped({&shared}, stream.get());
    downloadFrom(mapped.array(0), Element::kFloat, 2, 2, pixels, stream.get());
    stream.synchronize();
    if (pixels[3] != kDrawn) throw Error("CUDA does not see what GL draws");
    std::fill(std::begin(pixels), std::end(pixels), kWritten);
    uploadTo(mapped.array(0), Element::kFloat, 2, 2, pixels, stream.get());
  }
  if (shared.texture().downloadFloats().at(1, 1) != kWritten) {
    throw Error("GL does not see what CUDA writes");
  }
}

}  // namespace rangepose::cuda
