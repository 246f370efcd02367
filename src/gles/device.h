// What all passes share: the context, the compiled programs and the count of draws.
#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "gles/buffer.h"
#include "gles/context.h"
#include "gles/framebuffer.h"
#include "gles/programs.h"

namespace rangepose::gles {

class Device {
 public:
  /// `extra` macros are defined in every program. The context must outlive the device.
  explicit Device(Context& context, Defines extra = {});

  Context& context() { return context_; }
  /// Compiled at its first use.
  const Program& program(ProgramId id);
  std::int64_t draws() const { return draws_; }
  void countDraw() { ++draws_; }
  /// A vertex array without attributes: the vertex shader makes all from gl_VertexID.
  const VertexArray& noVertices() const { return no_vertices_; }

 private:
  Context& context_;
  Defines extra_;
  std::array<std::unique_ptr<Program>, static_cast<std::size_t>(ProgramId::kCount)> programs_;
  VertexArray no_vertices_;
  std::int64_t draws_ = 0;
};

/// One draw: a program, its inputs, its target. Leaves no state behind that another pass relies on.
class Pass {
 public:
  Pass(Device& device, ProgramId program, const Framebuffer& target);

  Pass& texture(const char* uniform, const Texture& texture);
  Pass& set(const char* uniform, int value);
  Pass& set(const char* uniform, float value);
  Pass& set(const char* uniform, const glm::ivec2& value);
  Pass& set(const char* uniform, const glm::vec2& value);
  Pass& set(const char* uniform, const glm::vec3& value);
  Pass& set(const char* uniform, const glm::vec4& value);
  Pass& set(const char* uniform, const glm::mat3& value);
  /// Draws into a part of the target, as if it were a target of its own.
  Pass& within(const PixelBox& box);
  /// Nearest wins.
  Pass& depthTest();
  /// Nothing is written; for queries.
  Pass& withoutWriting();

  /// region.vert: every region once.
  void draw(const Regions& regions);
  void drawQuads(const VertexArray& vertices, int instances);
  void drawPoints(int points, int instances);
  void drawTriangles(const VertexArray& vertices, int corners, int instances);

 private:
  void finish();
  Device& device_;
  const Program& program_;
  int units_ = 0;
};

}  // namespace rangepose::gles
