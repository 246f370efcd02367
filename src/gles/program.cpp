#include "gles/program.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <fstream>
#include <regex>
#include <sstream>

#include "core/error.h"
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

/// Line numbers tell the file too: those of file i begin after i * kLinesPerFile. (The number of a source string
/// would be the means for it, but Mesa drops it from some of its messages.)
constexpr int kLinesPerFile = 100000;

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
  int line = 1;
  for (const ShaderText& file : files) {
    text << "#line " << line << '\n' << file.text << '\n';
    line += kLinesPerFile;
  }
  return text.str();
}

std::string oneLine(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return std::iscntrl(c) != 0; }, ' ');
  const std::size_t end = text.find_last_not_of(' ');
  return end == std::string::npos ? "" : text.substr(0, end + 1);
}

/// The log with its places, "0:line(column)" (Mesa) or "0(line)" (NVIDIA), written as "file:line".
std::string compileMessage(const std::vector<ShaderText>& files, const std::string& log) {
  static const std::regex kPlace(R"(\d+:(\d+)\(\d+\)|\d+\((\d+)\)|\d+:(\d+))");
  std::string message;
  bool placed = false;
  auto rest = log.cbegin();
  for (std::smatch match; std::regex_search(rest, log.cend(), match, kPlace); rest = match[0].second) {
    const std::string number = match[1].str() + match[2].str() + match[3].str();
    const unsigned long line = std::strtoul(number.c_str(), nullptr, 10);
    const std::size_t file = line / kLinesPerFile;
    message.append(rest, match[0].first);
    const bool known = file < files.size();
    message += known ? files[file].name + ":" + std::to_string(line % kLinesPerFile) : match[0].str();
    placed = placed || known;
  }
  message.append(rest, log.cend());
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
