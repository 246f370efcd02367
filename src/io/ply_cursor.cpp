#include "io/ply_cursor.h"

#include <fmt/format.h>

#include <bit>
#include <limits>
#include <optional>

#include "core/error.h"
#include "io/file_bytes.h"
#include "io/text_scan.h"

namespace rangepose {

void PlyCursor::failTruncated() const {
  throw Error(where_ + ": the PLY is truncated: fewer values than its header says; write it again");
}

double PlyCursor::takeBinary(PlyType type) {
  const std::size_t count = plyTypeBytes(type);
  if (rest_.size() < count) failTruncated();
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t from = format_ == PlyFormat::kBigEndian ? i : count - 1 - i;
    bits = bits << 8 | static_cast<unsigned char>(rest_[from]);
  }
  rest_.remove_prefix(count);
  switch (type) {
    case PlyType::kInt8:
      return static_cast<std::int8_t>(bits);
    case PlyType::kUint8:
    case PlyType::kUint16:
    case PlyType::kUint32:
      return static_cast<double>(bits);
    case PlyType::kInt16:
      return static_cast<std::int16_t>(bits);
    case PlyType::kInt32:
      return static_cast<std::int32_t>(bits);
    case PlyType::kFloat32:
      return std::bit_cast<float>(static_cast<std::uint32_t>(bits));
    case PlyType::kFloat64:
      return std::bit_cast<double>(bits);
  }
  return 0.0;
}

double PlyCursor::take(PlyType type) {
  if (format_ != PlyFormat::kAscii) return takeBinary(type);
  const std::string_view word = takeWord(rest_);
  if (word.empty()) failTruncated();
  const std::optional<double> value = parseNumber(word);
  if (!value) {
    throw Error(fmt::format("{}: the PLY holds \"{}\" where a number is expected",
                            where_,
                            oneLine(word.substr(0, 20))));
  }
  return *value;
}

int PlyCursor::takeListLength(const PlyProperty& property) {
  const double length = take(property.count_type);
  const std::size_t each = format_ == PlyFormat::kAscii ? 2 : plyTypeBytes(property.type);
  const std::size_t room = (rest_.size() + 1) / each;
  if (!(length >= 0.0) || length > std::numeric_limits<int>::max()) {
    throw Error(fmt::format("{}: a PLY list \"{}\" of length {}; repair the file",
                            where_,
                            oneLine(property.name),
                            length));
  }
  if (static_cast<std::size_t>(length) > room) failTruncated();
  return static_cast<int>(length);
}

void PlyCursor::skip(const PlyProperty& property) {
  if (!property.is_list) {
    take(property.type);
    return;
  }
  const int length = takeListLength(property);
  for (int i = 0; i < length; ++i) take(property.type);
}

}  // namespace rangepose
