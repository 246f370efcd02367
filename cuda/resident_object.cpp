#include "cuda/packed_views.h"
#include "cuda/search.h"

namespace rangepose::cuda {
namespace {

PackedViews checkedPack(const ReferenceObject& object) {
  RP_CHECK(!object.views.empty() && object.size > 0 && object.atlas.width() % object.size == 0 &&
               object.columns() * (object.atlas.height() / object.size) >=
                   static_cast<int>(object.views.size()),
           "object " + std::to_string(object.id) + ": the atlas has fewer tiles than views");
  return packViews(object);
}

}  // namespace

ResidentObject::ResidentObject(const ReferenceObject& object, cudaStream_t stream)
    : outside_distance_(-static_cast<float>(object.edt_passes + 1)) {
  const PackedViews packed = checkedPack(object);
  most_pixels_ = packed.most_pixels;
  most_even_pixels_ = packed.most_even_pixels;
  entries_ = Buffer<ViewEntry>(packed.entries, stream);
  pixels_ = Buffer<ViewPixel>(packed.pixels, stream);
}

}  // namespace rangepose::cuda
