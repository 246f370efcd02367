#include "gles/program.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "core/error.h"
#include "gles/gl_text.h"
#include "gles/shader_library.h"

namespace rangepose::gles {
namespace {

constexpr const char* kPrecision =
    "precision highp float;\nprecision highp int;\nprecision highp sampler2D;\n"
    "precision highp isampler2D;\n";

std::vector<ShaderText> load(const std::vector<std::string>& names) {
  std::vector<ShaderText> texts;
  texts.reserve(names.size());
  for (const std::string& name : names) texts.push_back({name, shaderText(name)});
  return texts;
}

/// Line numbers tell the file too: file i begins with line (i + 1) * kLinesPerFile + 1. (The number
/// of a source string would be the means for it, but Mesa drops it from some of its messages.)
constexpr unsigned long kLinesPerFile = 100000;

std::string joined(const Context& context,
                   const std::vector<ShaderText>& files,
                   const Defines& defines) {
  std::ostringstream text;
  text << "#version 310 es\n";
  if (context.info().precise) {
    text << "#extension GL_EXT_gpu_shader5 : require\n#define RP_PRECISE precise\n";
  } else {
    text << "#define RP_PRECISE\n";
  }
  text << kPrecision;
  for (const auto& [name, value] : defines) text << "#define " << name << ' ' << value << '\n';
  unsigned long line = kLinesPerFile + 1;
  for (const ShaderText& file : files) {
    text << "#line " << line << '\n' << file.text << '\n';
    line += kLinesPerFile;
  }
  return text.str();
}

/// The log with its line numbers written as "file:line". Drivers put a number of their own in
/// front, "0:line" (Mesa) or "0(line" (NVIDIA), which goes away.
std::string compileMessage(const std::vector<ShaderText>& files, const std::string& log) {
  std::string message;
  bool placed = false;
  for (std::size_t at = 0; at < log.size();) {
    const std::size_t end = std::min(log.find_first_not_of("0123456789", at), log.size());
    const unsigned long number = end > at ? std::strtoul(log.c_str() + at, nullptr, 10) : 0;
    const std::size_t file = number / kLinesPerFile;
    if (file >= 1 && file <= files.size()) {
      if (message.ends_with("0:") || message.ends_with("0(")) message.resize(message.size() - 2);
      message += files[file - 1].name + ":" + std::to_string(number % kLinesPerFile);
      placed = true;
      at = end;
    } else {
      const std::size_t next = std::max(end, at + 1);
      message.append(log, at, next - at);
      at = next;
    }
  }
  return "shader " + (placed ? "" : files.back().name + ": ") + oneLine(message);
}

ShaderHandle compile(GLenum stage, const std::vector<ShaderText>& files, const std::string& text) {
  ShaderHandle shader(glCreateShader(stage));
  const char* source = text.c_str();
  glShaderSource(shader.id(), 1, &source, nullptr);
  glCompileShader(shader.id());
  GLint compiled = GL_FALSE;
  glGetShaderiv(shader.id(), GL_COMPILE_STATUS, &compiled);
  if (compiled == GL_TRUE) return shader;
  std::string log(4096, '\0');
  GLsizei length = 0;
  glGetShaderInfoLog(shader.id(), static_cast<GLsizei>(log.size()), &length, log.data());
  log.resize(static_cast<std::size_t>(std::max(length, 0)));
  throw Error(compileMessage(files, log));
}

}  // namespace

std::vector<std::string> shaderNames() {
  std::vector<std::string> names;
  for (const detail::EmbeddedShader& shader : detail::embeddedShaders()) {
    names.emplace_back(shader.name);
  }
  return names;
}

std::string shaderText(const std::string& name) {
  const char* folder = std::getenv("RP_GLSL_DIR");
  if (folder != nullptr && *folder != '\0') {
    std::ifstream file(std::string(folder) + "/" + name);
    std::ostringstream text;
    text << file.rdbuf();
    RP_CHECK(file.good(), "shader " + name + ": not readable in RP_GLSL_DIR=" + folder);
    return text.str();
  }
  for (const detail::EmbeddedShader& shader : detail::embeddedShaders()) {
    if (name == shader.name) return shader.text;
  }
  throw Error("shader " + name + ": not embedded; list it in src/gles/CMakeLists.txt");
}

Program::Program(Context& context, const ProgramSource& source)
    : Program(context,
              load({source.vertex}).front(),
              load({source.fragment}).front(),
              load(source.chunks),
              source.defines) {}

Program::Program(Context& context,
                 const ShaderText& vertex,
                 const ShaderText& fragment,
                 const std::vector<ShaderText>& chunks,
                 const Defines& defines) {
  std::vector<ShaderText> vertex_files = chunks;
  vertex_files.push_back(vertex);
  std::vector<ShaderText> fragment_files = chunks;
  fragment_files.push_back(fragment);
  const ShaderHandle first =
      compile(GL_VERTEX_SHADER, vertex_files, joined(context, vertex_files, defines));
  const ShaderHandle second =
      compile(GL_FRAGMENT_SHADER, fragment_files, joined(context, fragment_files, defines));
  link(vertex.name + " + " + fragment.name, first.id(), second.id());
  listUniforms();
  context.checkGl(name_);
}

void Program::link(const std::string& name, GLuint vertex, GLuint fragment) {
  name_ = "program " + name;
  handle_ = ProgramHandle(glCreateProgram());
  glAttachShader(id(), vertex);
  glAttachShader(id(), fragment);
  glLinkProgram(id());
  GLint linked = GL_FALSE;
  glGetProgramiv(id(), GL_LINK_STATUS, &linked);
  if (linked == GL_TRUE) return;
  std::string log(4096, '\0');
  GLsizei length = 0;
  glGetProgramInfoLog(id(), static_cast<GLsizei>(log.size()), &length, log.data());
  log.resize(static_cast<std::size_t>(std::max(length, 0)));
  throw Error(name_ + ": " + oneLine(log));
}

void Program::listUniforms() {
  GLint count = 0;
  glGetProgramiv(id(), GL_ACTIVE_UNIFORMS, &count);
  for (GLuint i = 0; i < static_cast<GLuint>(count); ++i) {
    char name[128];
    GLint size = 0;
    GLenum type = 0;
    glGetActiveUniform(id(), i, sizeof name, nullptr, &size, &type, name);
    uniforms_[name] = glGetUniformLocation(id(), name);
  }
}

GLint Program::uniform(const std::string& name) const {
  const auto found = uniforms_.find(name);
  RP_CHECK(found != uniforms_.end(), name_ + " has no uniform " + name);
  return found->second;
}

}  // namespace rangepose::gles
