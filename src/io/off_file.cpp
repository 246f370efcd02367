#include "io/off_file.h"

#include <fmt/format.h>

#include <optional>

#include "core/error.h"
#include "io/file_bytes.h"
#include "io/mesh_file.h"
#include "io/text_scan.h"

namespace rangepose {
namespace {

class OffParser {
 public:
  OffParser(std::string_view bytes, const std::string& where) : rest_(bytes), where_(where) {}

  RawMesh parse() {
    std::string_view first = nextLine();
    takeKeyword(first);
    std::string_view counts = first;
    if (takeWord(first).empty()) counts = nextLine();
    const long long vertex_count = takeCount(counts);
    const long long face_count = takeCount(counts);
    checkRoom(vertex_count, face_count);
    mesh_.vertices.reserve(static_cast<std::size_t>(vertex_count));
    for (long long i = 0; i < vertex_count; ++i) takeVertex();
    for (long long i = 0; i < face_count; ++i) takeFace(i);
    return std::move(mesh_);
  }

 private:
  /// The next line with something on it; comments start with #.
  std::string_view nextLine() {
    while (!rest_.empty()) {
      std::string_view line = takeLine(rest_);
      line = line.substr(0, line.find('#'));
      std::string_view probe = line;
      if (!takeWord(probe).empty()) return line;
    }
    throw Error(where_ + ": the OFF is truncated: fewer lines than its counts say; write it again");
  }

  /// Takes OFF, COFF, NOFF, STOFF ... off the front; the first count may stick to it.
  void takeKeyword(std::string_view& line) {
    const std::size_t keyword = line.find("OFF");
    const std::string_view prefix = line.substr(0, keyword);
    if (keyword == std::string_view::npos ||
        prefix.find_first_not_of("STCN") != std::string_view::npos) {
      throw Error(where_ + ": not an OFF file of three-dimensional vertices");
    }
    line.remove_prefix(keyword + 3);
  }

  long long takeCount(std::string_view& line) {
    const std::string_view word = takeWord(line);
    const std::optional<long long> count = parseCount(word);
    if (count) return *count;
    throw Error(fmt::format("{}: the OFF holds \"{}\" where a whole number is expected",
                            where_,
                            oneLine(word.substr(0, 20))));
  }

  void checkRoom(long long vertex_count, long long face_count) const {
    constexpr long long kVertexBytes = 6;  // three digits and their separators
    constexpr long long kFaceBytes = 2;
    const auto room = static_cast<long long>(rest_.size()) + 1;
    if (vertex_count > room / kVertexBytes ||
        face_count > (room - vertex_count * kVertexBytes) / kFaceBytes) {
      throw Error(
          fmt::format("{}: the OFF is truncated: {} bytes cannot hold {} vertices and {} faces",
                      where_,
                      rest_.size(),
                      vertex_count,
                      face_count));
    }
  }

  void takeVertex() {
    std::string_view line = nextLine();
    glm::dvec3 vertex{0.0};
    for (int axis = 0; axis < 3; ++axis) {
      const std::optional<double> value = parseNumber(takeWord(line));
      if (!value) {
        throw Error(fmt::format(
            "{}: vertex {} of the OFF is not three numbers", where_, mesh_.vertices.size()));
      }
      vertex[axis] = *value;
    }
    mesh_.vertices.push_back(vertex);
  }

  void takeFace(long long face) {
    std::string_view line = nextLine();
    const long long count = takeCount(line);
    checkCornerCount(count, face, where_);
    std::vector<unsigned> corners;
    for (long long i = 0; i < count; ++i) {
      const std::optional<double> index = parseNumber(takeWord(line));
      if (!index) throw Error(fmt::format("{}: face {} of the OFF is cut short", where_, face));
      corners.push_back(checkedCorner(*index, mesh_.vertices.size(), face, where_));
    }
    appendTriangles(mesh_.vertices, std::move(corners), mesh_.triangles);
    checkFaceCount(mesh_.triangles.size(), where_);
  }

  std::string_view rest_;
  const std::string& where_;
  RawMesh mesh_;
};

}  // namespace

RawMesh parseOffMesh(std::string_view bytes, const std::string& where) {
  return OffParser(bytes, where).parse();
}

}  // namespace rangepose
