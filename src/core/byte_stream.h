// Bytes of plain values in a row, little endian: what binary files are made of.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <istream>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "core/error.h"

namespace rangepose {

static_assert(std::endian::native == std::endian::little, "files are little endian");

class ByteWriter {
 public:
  template <typename T>
  void value(const T& item) {
    static_assert(std::is_trivially_copyable_v<T>);
    const char* begin = reinterpret_cast<const char*>(&item);
    bytes_.insert(bytes_.end(), begin, begin + sizeof(T));
  }
  template <typename T>
  void array(const T* items, std::size_t count) {
    static_assert(std::is_trivially_copyable_v<T>);
    const char* begin = reinterpret_cast<const char*>(items);
    bytes_.insert(bytes_.end(), begin, begin + count * sizeof(T));
  }
  void text(const std::string& item) {
    value(static_cast<std::uint64_t>(item.size()));
    array(item.data(), item.size());
  }
  std::vector<char> take() { return std::move(bytes_); }

 private:
  std::vector<char> bytes_;
};

/// A type of file, for its header and for messages.
struct FileKind {
  char magic[4];
  std::uint32_t version;
  const char* name;    ///< e.g. "database"
  const char* remedy;  ///< what to do about a bad one, e.g. "build the database again"
};

/// Never reads past the end: throws Error instead, naming the file.
class ByteReader {
 public:
  ByteReader(const char* begin, std::size_t size, const FileKind& kind, std::string where)
      : next_(begin), left_(size), kind_(kind), where_(std::move(where)) {}

  template <typename T>
  T value() {
    static_assert(std::is_trivially_copyable_v<T>);
    T item;
    array(&item, 1);
    return item;
  }
  template <typename T>
  void array(T* items, std::size_t count) {
    need(count, sizeof(T));
    if (count == 0) return;
    std::memcpy(static_cast<void*>(items), next_, count * sizeof(T));
    next_ += count * sizeof(T);
    left_ -= count * sizeof(T);
  }
  /// A count of items of `item_size` bytes that must still follow.
  std::size_t count(std::size_t item_size) {
    const std::uint64_t items = value<std::uint64_t>();
    need(items, item_size);
    return static_cast<std::size_t>(items);
  }
  std::string text() {
    std::string item(count(1), '\0');
    array(item.data(), item.size());
    return item;
  }
  std::size_t left() const { return left_; }
  [[noreturn]] void fail(const std::string& what) const {
    throw Error(where_ + ": " + what + "; " + kind_.remedy);
  }

 private:
  void need(std::uint64_t items, std::size_t item_size) const {
    if (items > left_ / item_size) fail(std::string("truncated ") + kind_.name);
  }

  const char* next_;
  std::size_t left_;
  FileKind kind_;
  std::string where_;
};

/// FNV-1a over words of eight bytes: each step is one to one, so a single damaged word always
/// shows.
std::uint64_t checksum(const char* data, std::size_t size);

/// A whole file: magic, version, checksum of the payload, its size, the payload.
std::vector<char> framed(const FileKind& kind, const std::vector<char>& payload);

/// The checksum that the beginning of such a file states; nothing where the file is too short.
std::optional<std::uint64_t> statedChecksum(std::istream& file);

/// The payload of a file that `framed` made; `bytes` must outlive the reader. Throws Error, naming
/// `where`, for another type or version, and for a truncated or damaged file.
ByteReader payloadOf(const FileKind& kind,
                     const std::vector<char>& bytes,
                     const std::string& where);

}  // namespace rangepose
