// What the tests of src/io share: files in a folder of their own, and errors as text.
#pragma once

#include <bit>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

#include "support/temp_folder.h"

namespace rangepose::test {

std::string bytesOf(const std::filesystem::path& path);

/// The text of the Error that `action` throws; "" when it throws nothing. Fails the test when the
/// text is not one line.
std::string errorOf(const std::function<void()>& action);

/// Feeds beginnings of `whole` of many lengths to `read`, as a file named `name`, and expects Error
/// from each that is shorter than `complete` bytes. Nothing may be printed meanwhile.
void expectTruncationsRefused(const std::string& name,
                              std::string_view whole,
                              std::size_t complete,
                              const std::function<void(const std::filesystem::path&)>& read);

/// Changes bytes of `whole` at many places; each file must be read or give an Error of one line.
void expectDamageSurvived(const std::string& name,
                          std::string_view whole,
                          const std::function<void(const std::filesystem::path&)>& read);

/// The bytes of a value, little or big endian.
template <typename T>
std::string rawBytes(T value, bool big_endian = false) {
  std::string bytes(reinterpret_cast<const char*>(&value), sizeof(T));
  if (big_endian == (std::endian::native == std::endian::little)) {
    bytes.assign(bytes.rbegin(), bytes.rend());
  }
  return bytes;
}

}  // namespace rangepose::test
