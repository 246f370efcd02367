// Vertex data on the device.
#pragma once

#include <cstddef>
#include <vector>

#include "core/image.h"
#include "gles/handle.h"

namespace rangepose::gles {

/// Vertices or per-instance values.
class Buffer {
 public:
  Buffer(const void* data, std::size_t bytes);
  GLuint id() const { return handle_.id(); }

 private:
  BufferHandle handle_;
};

/// One attribute of a vertex array.
struct Attribute {
  GLuint location = 0;
  int components = 0;  ///< 1..4
  bool integer = false;
  int stride_bytes = 0;
  std::size_t offset_bytes = 0;
  bool per_instance = false;
};

/// Which buffers a draw reads; the buffers must outlive it.
class VertexArray {
 public:
  VertexArray();
  void add(const Buffer& buffer, const Attribute& attribute);
  GLuint id() const { return handle_.id(); }

 private:
  VertexArrayHandle handle_;
};

/// A rectangle that a pass draws, and the pixels that count as neighbours of its pixels.
struct Region {
  PixelBox box;
  PixelBox bounds;
};

/// Instances for region.vert.
class Regions {
 public:
  explicit Regions(const std::vector<Region>& regions);
  /// One region: a whole image.
  Regions(int width, int height);
  int count() const { return count_; }
  const VertexArray& vertices() const { return vertices_; }

 private:
  int count_;
  Buffer buffer_;
  VertexArray vertices_;
};

}  // namespace rangepose::gles
