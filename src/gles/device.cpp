#include "gles/device.h"

#include <utility>

namespace rangepose::gles {

Device::Device(Context& context, Defines extra) : context_(context), extra_(std::move(extra)) {}

const Program& Device::program(ProgramId id) {
  std::unique_ptr<Program>& slot = programs_[static_cast<std::size_t>(id)];
  if (!slot) {
    ProgramSource source = programSource(id);
    source.defines.insert(source.defines.end(), extra_.begin(), extra_.end());
    slot = std::make_unique<Program>(context_, source);
  }
  return *slot;
}

Pass::Pass(Device& device, ProgramId program, const Framebuffer& target)
    : device_(device), program_(device.program(program)) {
  target.bind();
  glUseProgram(program_.id());
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_BLEND);
  glDisable(GL_CULL_FACE);
  glDisable(GL_SCISSOR_TEST);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
}

Pass& Pass::texture(const char* uniform, const Texture& texture) {
  glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(units_));
  glBindTexture(GL_TEXTURE_2D, texture.id());
  glUniform1i(program_.uniform(uniform), units_);
  ++units_;
  return *this;
}

Pass& Pass::set(const char* uniform, int value) {
  glUniform1i(program_.uniform(uniform), value);
  return *this;
}

Pass& Pass::set(const char* uniform, float value) {
  glUniform1f(program_.uniform(uniform), value);
  return *this;
}

Pass& Pass::set(const char* uniform, const glm::ivec2& value) {
  glUniform2i(program_.uniform(uniform), value.x, value.y);
  return *this;
}

Pass& Pass::set(const char* uniform, const glm::vec2& value) {
  glUniform2f(program_.uniform(uniform), value.x, value.y);
  return *this;
}

Pass& Pass::set(const char* uniform, const glm::vec3& value) {
  glUniform3f(program_.uniform(uniform), value.x, value.y, value.z);
  return *this;
}

Pass& Pass::set(const char* uniform, const glm::vec4& value) {
  glUniform4f(program_.uniform(uniform), value.x, value.y, value.z, value.w);
  return *this;
}

Pass& Pass::set(const char* uniform, const glm::mat3& value) {
  glUniformMatrix3fv(program_.uniform(uniform), 1, GL_FALSE, &value[0].x);
  return *this;
}

Pass& Pass::within(const PixelBox& box) {
  glViewport(box.x0, box.y0, box.width(), box.height());
  return *this;
}

Pass& Pass::depthTest() {
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  glDepthMask(GL_TRUE);
  return *this;
}

Pass& Pass::withoutWriting() {
  glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  return *this;
}

void Pass::draw(const Regions& regions) { drawQuads(regions.vertices(), regions.count()); }

void Pass::drawQuads(const VertexArray& vertices, int instances) {
  glBindVertexArray(vertices.id());
  glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, instances);
  finish();
}

void Pass::drawPoints(int points, int instances) {
  glBindVertexArray(device_.noVertices().id());
  glDrawArraysInstanced(GL_POINTS, 0, points, instances);
  finish();
}

void Pass::drawTriangles(const VertexArray& vertices, int corners, int instances) {
  glBindVertexArray(vertices.id());
  glDrawArraysInstanced(GL_TRIANGLES, 0, corners, instances);
  finish();
}

void Pass::finish() {
  device_.countDraw();
  device_.context().checkGl(program_.name());
}

}  // namespace rangepose::gles
