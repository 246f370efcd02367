#include "gles/buffer.h"

#include <cstdint>

namespace rangepose::gles {

static_assert(sizeof(Region) == 8 * sizeof(std::int32_t));

Buffer::Buffer(const void* data, std::size_t bytes) {
  GLuint name = 0;
  glGenBuffers(1, &name);
  handle_ = BufferHandle(name);
  glBindBuffer(GL_ARRAY_BUFFER, name);
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(bytes), data, GL_STATIC_DRAW);
}

VertexArray::VertexArray() {
  GLuint name = 0;
  glGenVertexArrays(1, &name);
  handle_ = VertexArrayHandle(name);
}

void VertexArray::add(const Buffer& buffer, const Attribute& attribute) {
  glBindVertexArray(id());
  glBindBuffer(GL_ARRAY_BUFFER, buffer.id());
  // GL takes the offset into the buffer as a pointer.
  const void* offset = reinterpret_cast<const void*>(attribute.offset_bytes);  // NOLINT
  glEnableVertexAttribArray(attribute.location);
  if (attribute.integer) {
    glVertexAttribIPointer(
        attribute.location, attribute.components, GL_INT, attribute.stride_bytes, offset);
  } else {
    glVertexAttribPointer(attribute.location,
                          attribute.components,
                          GL_FLOAT,
                          GL_FALSE,
                          attribute.stride_bytes,
                          offset);
  }
  glVertexAttribDivisor(attribute.location, attribute.per_instance ? 1 : 0);
}

Regions::Regions(const std::vector<Region>& regions)
    : count_(static_cast<int>(regions.size())),
      buffer_(regions.data(), regions.size() * sizeof(Region)) {
  constexpr int kStride = sizeof(Region);
  vertices_.add(buffer_, {0, 4, true, kStride, offsetof(Region, box), true});
  vertices_.add(buffer_, {1, 4, true, kStride, offsetof(Region, bounds), true});
}

Regions::Regions(int width, int height)
    : Regions(std::vector<Region>{{{0, 0, width, height}, {0, 0, width, height}}}) {}

}  // namespace rangepose::gles
