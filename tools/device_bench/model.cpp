#include <fstream>
#include <sstream>

#include "core/byte_stream.h"
#include "device_bench/workload.h"

namespace rangepose::device_bench {
namespace {

constexpr FileKind kPly{{'p', 'l', 'y', '\n'}, 1, "model", "take one of models/"};

std::vector<char> bytesOf(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream all;
  all << in.rdbuf();
  const std::string text = all.str();
  if (!in || text.empty()) throw Error(file.string() + ": cannot be read");
  return {text.begin(), text.end()};
}

}  // namespace

Mesh readModel(const std::filesystem::path& file) {
  const std::vector<char> bytes = bytesOf(file);
  const std::string text(bytes.begin(), bytes.end());
  const std::string end = "end_header\n";
  const std::size_t body = text.find(end);
  std::size_t vertices = 0;
  std::size_t faces = 0;
  std::istringstream header(text.substr(0, body));
  for (std::string line; std::getline(header, line);) {
    std::istringstream words(line);
    std::string element;
    std::string name;
    words >> element >> name;
    if (element == "element") words >> (name == "vertex" ? vertices : faces);
  }
  if (body == std::string::npos || vertices == 0 || faces == 0 ||
      text.find("binary_little_endian") > body) {
    throw Error(file.string() + ": not a binary PLY file of triangles");
  }
  const std::size_t begin = body + end.size();
  ByteReader reader(bytes.data() + begin, bytes.size() - begin, kPly, file.string());
  Mesh mesh;
  mesh.name = file.stem().string();
  mesh.vertices.resize(vertices);
  reader.array(mesh.vertices.data(), vertices);
  for (std::size_t i = 0; i < faces; ++i) {
    if (reader.value<std::uint8_t>() != 3) reader.fail("a face that is no triangle");
    mesh.triangles.push_back(reader.value<glm::uvec3>());
  }
  return mesh;
}

}  // namespace rangepose::device_bench
