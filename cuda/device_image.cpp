#include "cuda/device_image.h"

#include <algorithm>
#include <utility>

#include "core/error.h"

namespace rangepose::cuda {
namespace {

/// Twice what a frame with three starts leaves in the pool.
constexpr std::size_t kMostFree = 48;

/// Each once, in order.
std::vector<const DeviceImage*> distinct(const std::vector<const DeviceImage*>& images) {
  std::vector<const DeviceImage*> once;
  for (const DeviceImage* image : images) {
    if (std::find(once.begin(), once.end(), image) == once.end()) once.push_back(image);
  }
  return once;
}

std::vector<const SharedTexture*> sharedOf(const std::vector<const DeviceImage*>& images) {
  std::vector<const SharedTexture*> shared;
  for (const DeviceImage* image : distinct(images)) {
    if (image->shared() != nullptr) shared.push_back(image->shared());
  }
  return shared;
}

}  // namespace

DeviceImage::DeviceImage(Memory memory, Element element, int width, int height)
    : element_(element), width_(width), height_(height) {
  if (memory == Memory::kShared) {
    shared_.emplace(element, width, height);
  } else {
    own_.emplace(element, width, height);
  }
}

Frame::Frame(const std::vector<const DeviceImage*>& images, cudaStream_t stream)
    : mapped_(sharedOf(images), stream), stream_(stream) {
  std::size_t next = 0;
  for (const DeviceImage* image : distinct(images)) {
    if (image->shared() != nullptr) {
      entries_.push_back({image, mapped_.array(next), mapped_.view(next)});
      ++next;
    } else {
      entries_.push_back({image, image->own_->array(), image->own_->view()});
    }
  }
}

const Frame::Entry& Frame::entry(const DeviceImage& image) const {
  const auto found = std::find_if(
      entries_.begin(), entries_.end(), [&](const Entry& entry) { return entry.image == &image; });
  RP_CHECK(found != entries_.end(), "CUDA frame: the image is not mapped in it");
  return *found;
}

ImageView Frame::view(const DeviceImage& image) const { return entry(image).view; }

void Frame::upload(const DeviceImage& image, const void* from) const {
  uploadTo(entry(image).array, image.element(), image.width(), image.height(), from, stream_);
}

void Frame::download(const DeviceImage& image, void* into) const {
  downloadFrom(entry(image).array, image.element(), image.width(), image.height(), into, stream_);
}

void ImagePool::makeRoom() {
  std::vector<DeviceImage*>& free = images_->free;
  if (free.size() <= kMostFree) return;
  const DeviceImage* oldest = free.front();
  free.erase(free.begin());
  std::erase_if(images_->all, [&](const auto& image) { return image.get() == oldest; });
}

ImagePool::Lease ImagePool::take(Element element, int width, int height) {
  const auto fits = [&](const DeviceImage* image) {
    return image->element() == element && image->width() == width && image->height() == height;
  };
  std::vector<DeviceImage*>& free = images_->free;
  const auto found = std::find_if(free.begin(), free.end(), fits);
  DeviceImage* image = nullptr;
  if (found != free.end()) {
    image = *found;
    free.erase(found);
  } else {
    // Scenes differ in size from image to image: what was not asked for again makes room.
    makeRoom();
    images_->all.push_back(std::make_unique<DeviceImage>(memory_, element, width, height));
    image = images_->all.back().get();
  }
  return Lease(image, [images = std::weak_ptr<Images>(images_)](DeviceImage* returned) {
    if (const std::shared_ptr<Images> pool = images.lock()) pool->free.push_back(returned);
  });
}

}  // namespace rangepose::cuda
