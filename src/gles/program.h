// A linked shader program.
#pragma once

#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "core/glm.h"
#include "gles/context.h"
#include "gles/handle.h"

namespace rangepose::gles {

using Defines = std::vector<std::pair<std::string, std::string>>;

/// The files and macros that make up a program.
struct ProgramSource {
  std::string vertex;               ///< file in glsl/
  std::string fragment;             ///< file in glsl/
  std::vector<std::string> chunks;  ///< files put in front of both, in this order
  Defines defines;
};

/// A text to compile and the file it is from.
struct ShaderText {
  std::string name;
  std::string text;
};

class Program {
 public:
  /// Throws Error naming file, line and the driver's message.
  Program(Context& context, const ProgramSource& source);
  Program(Context& context,
          const ShaderText& vertex,
          const ShaderText& fragment,
          const std::vector<ShaderText>& chunks,
          const Defines& defines);

  GLuint id() const { return handle_.id(); }
  /// For messages, e.g. "program region.vert + edges.frag".
  const std::string& name() const { return name_; }
  /// Throws Error when the program has no such uniform: a typing error, or it is not used.
  GLint uniform(const std::string& name) const;

 private:
  void link(const std::string& name, GLuint vertex, GLuint fragment);
  void listUniforms();

  std::string name_;
  ProgramHandle handle_;
  std::unordered_map<std::string, GLint> uniforms_;
};

}  // namespace rangepose::gles
