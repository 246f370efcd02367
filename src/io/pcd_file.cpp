#include "io/pcd_file.h"

#include <fmt/format.h>

#include <array>
#include <bit>
#include <cstdint>
#include <optional>

#include "core/error.h"
#include "io/file_bytes.h"
#include "io/lzf.h"
#include "io/pcd_header.h"
#include "io/text_scan.h"

namespace rangepose {
namespace {

[[noreturn]] void failTruncated(const std::string& where) {
  throw Error(where + ": the PCD is truncated: less data than its header says; write it again");
}

double floatAt(const char* bytes, long long size) {
  // PCD has no byte order of its own: it is that of the machines in use, little endian.
  std::uint64_t bits = 0;
  for (long long i = size; i > 0; --i) bits = bits << 8 | static_cast<unsigned char>(bytes[i - 1]);
  if (size == 8) return std::bit_cast<double>(bits);
  return std::bit_cast<float>(static_cast<std::uint32_t>(bits));
}

using Points = std::vector<glm::dvec3>;

Points parseAscii(const PcdHeader& header, std::string_view rest, const std::string& where) {
  std::size_t words_per_point = 0;
  std::array<std::size_t, 3> column{};
  for (std::size_t field = 0; field < header.fields.size(); ++field) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (header.axes[axis] == field) column[axis] = words_per_point;
    }
    words_per_point += static_cast<std::size_t>(header.fields[field].count);
  }
  const auto count = static_cast<std::size_t>(header.points);
  if (2 * words_per_point * count > rest.size() + 1) failTruncated(where);
  Points points(count);
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t word_index = 0; word_index < words_per_point; ++word_index) {
      const std::string_view word = takeWord(rest);
      if (word.empty()) failTruncated(where);
      for (int axis = 0; axis < 3; ++axis) {
        if (column[static_cast<std::size_t>(axis)] != word_index) continue;
        const std::optional<double> value = parseNumber(word);
        if (!value) {
          throw Error(fmt::format("{}: point {} of the PCD holds \"{}\" where a number is expected",
                                  where,
                                  i,
                                  oneLine(word.substr(0, 20))));
        }
        points[i][axis] = *value;
      }
    }
  }
  return points;
}

/// Value `axis` of point i lies at start[axis] + i * stride[axis].
Points gather(const PcdHeader& header,
              std::string_view data,
              const std::array<std::size_t, 3>& start,
              const std::array<std::size_t, 3>& stride) {
  Points points(static_cast<std::size_t>(header.points));
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      points[i][static_cast<int>(axis)] =
          floatAt(data.data() + start[axis] + i * stride[axis], header.axis(axis).size);
    }
  }
  return points;
}

Points parseBinary(const PcdHeader& header, std::string_view rest, const std::string& where) {
  if (static_cast<std::size_t>(header.points) > rest.size() / header.point_bytes) {
    failTruncated(where);
  }
  std::array<std::size_t, 3> start{};
  for (std::size_t axis = 0; axis < 3; ++axis) start[axis] = header.axis(axis).offset;
  return gather(header, rest, start, {header.point_bytes, header.point_bytes, header.point_bytes});
}

std::size_t sizeAt(std::string_view bytes, std::size_t offset) {
  std::size_t value = 0;
  for (std::size_t i = 4; i > 0; --i) {
    value = value << 8 | static_cast<unsigned char>(bytes[offset + i - 1]);
  }
  return value;
}

/// Compressed data keeps each field together: all x, then all y, ...
Points parseCompressed(const PcdHeader& header, std::string_view rest, const std::string& where) {
  constexpr std::size_t kBestRatio = 100;  // LZF makes at most 264 bytes out of 3
  if (rest.size() < 8) failTruncated(where);
  const std::size_t packed_bytes = sizeAt(rest, 0);
  const std::size_t expanded_bytes = sizeAt(rest, 4);
  rest.remove_prefix(8);
  if (packed_bytes > rest.size()) failTruncated(where);
  const auto count = static_cast<std::size_t>(header.points);
  if (expanded_bytes != count * header.point_bytes || expanded_bytes / kBestRatio > packed_bytes) {
    throw Error(fmt::format("{}: the compressed PCD data gives {} bytes for {} points of {}",
                            where,
                            expanded_bytes,
                            count,
                            header.point_bytes));
  }
  const std::string data = expandLzf(rest.substr(0, packed_bytes), expanded_bytes, where);
  std::array<std::size_t, 3> start{};
  std::array<std::size_t, 3> stride{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    start[axis] = header.axis(axis).offset * count;
    stride[axis] = header.axis(axis).bytes();
  }
  return gather(header, data, start, stride);
}

}  // namespace

bool looksLikePcd(std::string_view bytes) {
  for (std::string_view line = takeLine(bytes); !bytes.empty(); line = takeLine(bytes)) {
    const std::string_view word = takeWord(line);
    if (word.starts_with("#") || word.empty()) continue;
    return word == "VERSION" || word == "FIELDS" || word == "COLUMNS";
  }
  return false;
}

PcdPoints parsePcd(std::string_view bytes, const std::string& where) {
  const PcdHeader header = takePcdHeader(bytes, where);
  PcdPoints result;
  result.width = static_cast<int>(header.width);
  result.height = static_cast<int>(header.height);
  if (header.data == "ascii") {
    result.points = parseAscii(header, bytes, where);
  } else if (header.data == "binary") {
    result.points = parseBinary(header, bytes, where);
  } else if (header.data == "binary_compressed") {
    result.points = parseCompressed(header, bytes, where);
  } else {
    throw Error(where + ": the PCD has DATA other than ascii, binary or binary_compressed");
  }
  return result;
}

}  // namespace rangepose
