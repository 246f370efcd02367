#include "core/byte_stream.h"

namespace rangepose {

std::uint64_t checksum(const char* data, std::size_t size) {
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  const auto mix = [&hash](std::uint64_t word) {
    hash = (hash ^ word) * 0x100000001b3ULL;
    hash ^= hash >> 32;
  };
  std::size_t i = 0;
  for (; i + 8 <= size; i += 8) {
    std::uint64_t word = 0;
    std::memcpy(&word, data + i, 8);
    mix(word);
  }
  for (; i < size; ++i) mix(static_cast<unsigned char>(data[i]));
  return hash;
}

std::vector<char> framed(const FileKind& kind, const std::vector<char>& payload) {
  ByteWriter file;
  file.array(kind.magic, sizeof kind.magic);
  file.value(kind.version);
  file.value(checksum(payload.data(), payload.size()));
  file.value(static_cast<std::uint64_t>(payload.size()));
  file.array(payload.data(), payload.size());
  return file.take();
}

std::optional<std::uint64_t> statedChecksum(std::istream& file) {
  file.seekg(sizeof FileKind::magic + sizeof FileKind::version);
  std::uint64_t sum = 0;
  if (!file.read(reinterpret_cast<char*>(&sum), sizeof sum)) return std::nullopt;
  return sum;
}

ByteReader payloadOf(const FileKind& kind,
                     const std::vector<char>& bytes,
                     const std::string& where) {
  const std::string name = kind.name;
  ByteReader header(bytes.data(), bytes.size(), kind, where);
  char magic[sizeof kind.magic] = {};
  if (bytes.size() >= sizeof magic) header.array(magic, sizeof magic);
  if (std::memcmp(magic, kind.magic, sizeof magic) != 0) {
    throw Error(where + ": not a rangepose " + name + "; make one with `rangepose build`");
  }
  const std::uint32_t version = header.value<std::uint32_t>();
  if (version != kind.version) {
    header.fail(name + " version " + std::to_string(version) + ", this program reads version " +
                std::to_string(kind.version));
  }
  const std::uint64_t expected = header.value<std::uint64_t>();
  const std::uint64_t size = header.value<std::uint64_t>();
  if (size > header.left()) header.fail("truncated " + name);
  if (size < header.left()) header.fail("bytes after the end of the " + name);
  const char* payload = bytes.data() + (bytes.size() - header.left());
  if (checksum(payload, header.left()) != expected) header.fail("damaged " + name + " (checksum)");
  return {payload, header.left(), kind, where};
}

}  // namespace rangepose
