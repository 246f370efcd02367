#include "gles/channels_gles.h"

#include <utility>

namespace rangepose::gles {
namespace {

/// One draw over a whole image.
class ImagePass {
 public:
  ImagePass(Device& device, const Texture& image)
      : device_(device), size_(image.width(), image.height()), whole_(size_.x, size_.y) {}

  Canvas canvas(Format format) const { return {format, size_.x, size_.y}; }
  Pass into(const Canvas& target, ProgramId program) {
    Pass pass(device_, program, target.framebuffer);
    pass.set("u_target_size", size_);
    return pass;
  }
  const Regions& whole() const { return whole_; }

 private:
  Device& device_;
  glm::ivec2 size_;
  Regions whole_;
};

/// Whether the query's pass wrote anything.
bool anyPassed(const QueryHandle& query) {
  GLuint passed = 0;
  glGetQueryObjectuiv(query.id(), GL_QUERY_RESULT, &passed);
  return passed != 0;
}

}  // namespace

Canvas median(Device& device, const Texture& range) {
  ImagePass image(device, range);
  Canvas result = image.canvas(Format::kR32f);
  image.into(result, ProgramId::kMedian).texture("u_range", range).draw(image.whole());
  return result;
}

Canvas edges(Device& device, const Texture& range_px, float threshold_px) {
  ImagePass image(device, range_px);
  Canvas result = image.canvas(Format::kR32f);
  image.into(result, ProgramId::kEdges)
      .texture("u_range", range_px)
      .set("u_threshold_px", threshold_px)
      .draw(image.whole());
  return result;
}

Canvas distanceTexels(Device& device, const Texture& range_px, const Texture& edges, int passes) {
  ImagePass image(device, range_px);
  Canvas current = image.canvas(Format::kRgba32f);
  Canvas next = image.canvas(Format::kRgba32f);
  image.into(current, ProgramId::kEdtInit)
      .texture("u_range", range_px)
      .texture("u_edges", edges)
      .set("u_passes", passes)
      .draw(image.whole());
  for (int pass = 0; pass < passes; ++pass) {
    image.into(next, ProgramId::kEdtStep)
        .texture("u_previous", current.texture)
        .draw(image.whole());
    std::swap(current, next);
  }
  return current;
}

Canvas distance(Device& device, const Texture& range_px, const Texture& edges, int passes) {
  const Canvas texels = distanceTexels(device, range_px, edges, passes);
  ImagePass image(device, range_px);
  Canvas result = image.canvas(Format::kR32f);
  image.into(result, ProgramId::kEdtRoot).texture("u_texels", texels.texture).draw(image.whole());
  return result;
}

Canvas patches(Device& device, const Texture& range_px, const Texture& edges) {
  constexpr int kPassesPerCheck = 4;  // reading the answer waits for the device
  ImagePass image(device, range_px);
  Canvas current = image.canvas(Format::kR32i);
  Canvas next = image.canvas(Format::kR32i);
  image.into(current, ProgramId::kPatchInit)
      .texture("u_range", range_px)
      .texture("u_edges", edges)
      .set("u_width", range_px.width())
      .draw(image.whole());
  GLuint name = 0;
  glGenQueries(1, &name);
  const QueryHandle query(name);
  for (bool changed = true; changed;) {
    for (int pass = 0; pass < kPassesPerCheck; ++pass) {
      image.into(next, ProgramId::kPatchStep)
          .texture("u_previous", current.texture)
          .set("u_width", range_px.width())
          .draw(image.whole());
      std::swap(current, next);
    }
    // `next` holds the last but one pass; its own framebuffer cannot be the target while it is
    // read.
    const Canvas unused = image.canvas(Format::kR32i);
    glBeginQuery(GL_ANY_SAMPLES_PASSED, query.id());
    image.into(unused, ProgramId::kPatchChanged)
        .texture("u_previous", next.texture)
        .texture("u_current", current.texture)
        .withoutWriting()
        .draw(image.whole());
    glEndQuery(GL_ANY_SAMPLES_PASSED);
    changed = anyPassed(query);
  }
  return current;
}

}  // namespace rangepose::gles
