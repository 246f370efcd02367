#include "gles/program.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>

#include "core/error.h"
#include "gles/programs.h"
#include "gles/shader_library.h"
#include "support/backends.h"

namespace rangepose::gles {
namespace {

using testing::HasSubstr;

constexpr const char* kVertex = "void main() { gl_Position = vec4(0.0); }\n";
constexpr const char* kFragment =
    "layout(location = 0) out highp vec4 o_color;\nvoid main() { o_color = vec4(1.0); }\n";

std::set<std::string> filesOnDisk() {
  const std::filesystem::path folder = std::filesystem::path(RP_SOURCE_DIR) / "glsl";
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) {
      names.insert(std::filesystem::relative(entry.path(), folder).generic_string());
    }
  }
  return names;
}

std::set<std::string> filesInPrograms() {
  std::set<std::string> names;
  for (int id = 0; id < static_cast<int>(ProgramId::kCount); ++id) {
    const ProgramSource source = programSource(static_cast<ProgramId>(id));
    names.insert(source.vertex);
    names.insert(source.fragment);
    names.insert(source.chunks.begin(), source.chunks.end());
  }
  return names;
}

TEST(ShaderLibrary, ListsEveryFileOfGlsl) {
  const std::vector<std::string> names = shaderNames();
  EXPECT_EQ(std::set<std::string>(names.begin(), names.end()), filesOnDisk())
      << "list the file in src/gles/CMakeLists.txt";
}

TEST(ShaderLibrary, EveryFileIsPartOfAProgram) { EXPECT_EQ(filesInPrograms(), filesOnDisk()); }

TEST(ShaderLibrary, EmbedsTheTextAsItIsOnDisk) {
  for (const std::string& name : shaderNames()) {
    std::ifstream file(std::string(RP_SOURCE_DIR) + "/glsl/" + name);
    std::ostringstream text;
    text << file.rdbuf();
    EXPECT_EQ(shaderText(name), text.str()) << name;
  }
}

TEST(ShaderLibrary, UnknownNamesAreAnError) { EXPECT_THROW(shaderText("nothing.frag"), Error); }

using ProgramTest = test::GlesFixture;

TEST_F(ProgramTest, EveryProgramCompiles) {
  for (int id = 0; id < static_cast<int>(ProgramId::kCount); ++id) {
    const ProgramSource source = programSource(static_cast<ProgramId>(id));
    EXPECT_NO_THROW(Program(context(), source)) << source.vertex << " + " << source.fragment;
  }
}

std::string messageOf(Context& context,
                      const std::string& fragment,
                      const std::vector<ShaderText>& chunks) {
  try {
    const Program program(
        context, {"good.vert", kVertex}, {"broken.frag", fragment}, chunks, {{"RP_X", "1"}});
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST_F(ProgramTest, ABrokenShaderIsNamedWithItsLine) {
  const std::string message = messageOf(
      context(),
      "layout(location = 0) out highp vec4 o_color;\n\nvoid main() { o_color = nonsense; }\n",
      {});
  EXPECT_THAT(message, HasSubstr("broken.frag:3"));
  EXPECT_THAT(message, HasSubstr("nonsense"));
  EXPECT_EQ(message.find('\n'), std::string::npos);
}

TEST_F(ProgramTest, ABrokenChunkIsNamedInsteadOfTheBody) {
  const std::vector<ShaderText> chunks = {
      {"common/good.glsl", "float one() { return 1.0; }\n"},
      {"common/bad.glsl", "\nfloat two() { return missing; }\n"}};
  // Both stages hold the chunks, so the vertex shader fails first; the message still names the
  // chunk.
  EXPECT_THAT(messageOf(context(), kFragment, chunks), HasSubstr("common/bad.glsl:2"));
}

TEST_F(ProgramTest, AMisspelledUniformIsAnError) {
  const Program program(context(), {"good.vert", kVertex}, {"good.frag", kFragment}, {}, {});
  EXPECT_THROW(static_cast<void>(program.uniform("u_nothing")), Error);
}

TEST_F(ProgramTest, StagesThatDoNotMatchAreALinkError) {
  const std::string fragment =
      "in highp vec3 v_missing;\nlayout(location = 0) out highp vec4 o_color;\n"
      "void main() { o_color = vec4(v_missing, 1.0); }\n";
  EXPECT_THAT(messageOf(context(), fragment, {}), HasSubstr("good.vert + broken.frag"));
}

TEST_F(ProgramTest, ReadsFromAFolderWhereOneIsNamed) {
  namespace fs = std::filesystem;
  const fs::path folder = fs::path(testing::TempDir()) / "rangepose_glsl_test";
  fs::create_directories(folder);
  fs::copy_file(fs::path(RP_SOURCE_DIR) / "glsl/region.vert",
                folder / "region.vert",
                fs::copy_options::overwrite_existing);
  std::ofstream(folder / "median.frag") << "// edited\nvoid main() { edited(); }\n";
  setenv("RP_GLSL_DIR", folder.c_str(), 1);
  std::string message;
  try {
    const Program program(context(), programSource(ProgramId::kMedian));
  } catch (const Error& error) {
    message = error.what();
  }
  EXPECT_THROW(shaderText("edges.frag"), Error) << "the folder has no such file";
  unsetenv("RP_GLSL_DIR");
  fs::remove_all(folder);
  EXPECT_THAT(message, HasSubstr("median.frag:2"));
}

}  // namespace
}  // namespace rangepose::gles
