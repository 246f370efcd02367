#include "io/ply_header.h"

#include <fmt/format.h>

#include <array>
#include <optional>
#include <utility>

#include "core/error.h"
#include "io/file_bytes.h"
#include "io/text_scan.h"

namespace rangepose {
namespace {

std::optional<PlyType> typeNamed(std::string_view name) {
  static constexpr std::array<std::pair<std::string_view, PlyType>, 16> kNames{{
      {"char", PlyType::kInt8},
      {"int8", PlyType::kInt8},
      {"uchar", PlyType::kUint8},
      {"uint8", PlyType::kUint8},
      {"short", PlyType::kInt16},
      {"int16", PlyType::kInt16},
      {"ushort", PlyType::kUint16},
      {"uint16", PlyType::kUint16},
      {"int", PlyType::kInt32},
      {"int32", PlyType::kInt32},
      {"uint", PlyType::kUint32},
      {"uint32", PlyType::kUint32},
      {"float", PlyType::kFloat32},
      {"float32", PlyType::kFloat32},
      {"double", PlyType::kFloat64},
      {"float64", PlyType::kFloat64},
  }};
  for (const auto& [text, type] : kNames) {
    if (text == name) return type;
  }
  return std::nullopt;
}

class HeaderParser {
 public:
  HeaderParser(std::string_view bytes, const std::string& where) : rest_(bytes), where_(where) {}

  PlyHeader parse() {
    if (takeLine(rest_) != "ply")
      throw Error(where_ + ": not a PLY file (it does not start with ply)");
    bool has_format = false;
    for (;;) {
      if (rest_.empty()) fail("has no end_header; the file is truncated or no PLY");
      const std::string_view line = takeLine(rest_);
      const std::vector<std::string> words = wordsOf(line);
      if (words.empty()) continue;
      if (words[0] == "end_header") break;
      if (words[0] == "format") {
        parseFormat(words, line);
        has_format = true;
      } else if (words[0] == "element") {
        parseElement(words, line);
      } else if (words[0] == "property") {
        parseProperty(words, line);
      } else if (words[0] == "comment" || words[0] == "obj_info") {
        parseRemark(words);
      } else {
        failLine(line);
      }
    }
    if (!has_format) fail("has no format line");
    header_.body = rest_;
    checkCounts();
    return header_;
  }

 private:
  [[noreturn]] void fail(const std::string& problem) const {
    throw Error(where_ + ": the PLY header " + problem);
  }
  [[noreturn]] void failLine(std::string_view line) const {
    fail(fmt::format("has a line that is not understood: {}", oneLine(line.substr(0, 60))));
  }

  void parseFormat(const std::vector<std::string>& words, std::string_view line) {
    if (words.size() < 2) failLine(line);
    if (words[1] == "ascii") {
      header_.format = PlyFormat::kAscii;
    } else if (words[1] == "binary_little_endian") {
      header_.format = PlyFormat::kLittleEndian;
    } else if (words[1] == "binary_big_endian") {
      header_.format = PlyFormat::kBigEndian;
    } else {
      failLine(line);
    }
  }

  void parseElement(const std::vector<std::string>& words, std::string_view line) {
    const std::optional<long long> count = words.size() == 3 ? parseCount(words[2]) : std::nullopt;
    if (!count) failLine(line);
    header_.elements.push_back({words[1], *count, {}});
  }

  void parseProperty(const std::vector<std::string>& words, std::string_view line) {
    if (header_.elements.empty()) failLine(line);
    PlyProperty property;
    property.is_list = words.size() == 5 && words[1] == "list";
    if (!property.is_list && words.size() != 3) failLine(line);
    property.name = words.back();
    const std::optional<PlyType> type = typeNamed(words[words.size() - 2]);
    const std::optional<PlyType> count_type = typeNamed(words[property.is_list ? 2 : 1]);
    if (!type || !count_type) failLine(line);
    if (property.is_list &&
        (*count_type == PlyType::kFloat32 || *count_type == PlyType::kFloat64)) {
      failLine(line);
    }
    property.type = *type;
    property.count_type = *count_type;
    header_.elements.back().properties.push_back(property);
  }

  void parseRemark(const std::vector<std::string>& words) {
    if (words.size() != 3) return;
    if (words[1] == "num_cols") header_.grid_columns = parseCount(words[2]).value_or(0);
    if (words[1] == "num_rows") header_.grid_rows = parseCount(words[2]).value_or(0);
  }

  /// The fewest bytes that one element can take.
  std::size_t leastBytes(const PlyElement& element) const {
    std::size_t bytes = 0;
    for (const PlyProperty& property : element.properties) {
      if (header_.format == PlyFormat::kAscii) {
        bytes += 2;  // a digit and a separator
      } else {
        bytes += plyTypeBytes(property.is_list ? property.count_type : property.type);
      }
    }
    return bytes;
  }

  void checkCounts() const {
    // The last value of an ASCII file may lack its separator.
    std::size_t left = header_.body.size() + (header_.format == PlyFormat::kAscii ? 1 : 0);
    for (const PlyElement& element : header_.elements) {
      const std::size_t each = leastBytes(element);
      if (each == 0) continue;
      if (static_cast<std::uint64_t>(element.count) > left / each) {
        throw Error(fmt::format("{}: the PLY is truncated: {} bytes cannot hold {} of element {}",
                                where_,
                                header_.body.size(),
                                element.count,
                                oneLine(element.name)));
      }
      left -= static_cast<std::size_t>(element.count) * each;
    }
  }

  std::string_view rest_;
  const std::string& where_;
  PlyHeader header_;
};

}  // namespace

std::size_t plyTypeBytes(PlyType type) {
  switch (type) {
    case PlyType::kInt8:
    case PlyType::kUint8:
      return 1;
    case PlyType::kInt16:
    case PlyType::kUint16:
      return 2;
    case PlyType::kInt32:
    case PlyType::kUint32:
    case PlyType::kFloat32:
      return 4;
    case PlyType::kFloat64:
      return 8;
  }
  return 8;
}

int PlyElement::indexOf(std::string_view property) const {
  for (std::size_t i = 0; i < properties.size(); ++i) {
    if (properties[i].name == property) return static_cast<int>(i);
  }
  return -1;
}

PlyHeader parsePlyHeader(std::string_view bytes, const std::string& where) {
  return HeaderParser(bytes, where).parse();
}

}  // namespace rangepose
