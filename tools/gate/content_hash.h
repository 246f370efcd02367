// Tells contents apart, for names of files in the cache: FNV-1a, 64 bits.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace rangepose::gate {

class ContentHash {
 public:
  /// Texts that follow each other differ from one text of both.
  ContentHash& add(std::string_view text);
  /// The bytes of a file. Throws Error where it cannot be read.
  ContentHash& addFile(const std::filesystem::path& path);
  /// Names and bytes of all files below a folder, by name.
  ContentHash& addFolder(const std::filesystem::path& folder);
  /// 16 hexadecimal digits.
  std::string text() const;

 private:
  void addBytes(std::string_view bytes);
  std::uint64_t value_ = 0xCBF29CE484222325u;
};

}  // namespace rangepose::gate
