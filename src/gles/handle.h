// A GL object name that is deleted with its owner.
#pragma once

#include <utility>

#include "gles/gl.h"

namespace rangepose::gles {

/// Owns one GL name; 0 owns nothing. The context must be current when it is destroyed.
template <void (*Delete)(GLuint)>
class Handle {
 public:
  Handle() = default;
  explicit Handle(GLuint id) : id_(id) {}
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, 0)) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(id_, other.id_);
    return *this;
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  ~Handle() {
    if (id_ != 0) Delete(id_);
  }
  GLuint id() const { return id_; }

 private:
  GLuint id_ = 0;
};

inline void deleteTexture(GLuint id) { glDeleteTextures(1, &id); }
inline void deleteFramebuffer(GLuint id) { glDeleteFramebuffers(1, &id); }
inline void deleteBuffer(GLuint id) { glDeleteBuffers(1, &id); }
inline void deleteVertexArray(GLuint id) { glDeleteVertexArrays(1, &id); }
inline void deleteQuery(GLuint id) { glDeleteQueries(1, &id); }
inline void deleteShader(GLuint id) { glDeleteShader(id); }
inline void deleteProgram(GLuint id) { glDeleteProgram(id); }

using TextureHandle = Handle<deleteTexture>;
using FramebufferHandle = Handle<deleteFramebuffer>;
using BufferHandle = Handle<deleteBuffer>;
using VertexArrayHandle = Handle<deleteVertexArray>;
using QueryHandle = Handle<deleteQuery>;
using ShaderHandle = Handle<deleteShader>;
using ProgramHandle = Handle<deleteProgram>;

}  // namespace rangepose::gles
