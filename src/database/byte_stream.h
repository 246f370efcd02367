// Bytes of plain values in a row, little endian: what the database file is made of.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
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

/// Never reads past the end: throws Error instead, naming the file.
class ByteReader {
 public:
  ByteReader(const char* begin, std::size_t size, std::string where)
      : next_(begin), left_(size), where_(std::move(where)) {}

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
    throw Error(where_ + ": " + what + "; build the database again");
  }

 private:
  void need(std::uint64_t items, std::size_t item_size) const {
    if (items > left_ / item_size) fail("truncated database");
  }

  const char* next_;
  std::size_t left_;
  std::string where_;
};

}  // namespace rangepose
