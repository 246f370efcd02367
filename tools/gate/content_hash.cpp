#include "gate/content_hash.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <vector>

#include "core/error.h"

namespace rangepose::gate {

namespace fs = std::filesystem;

void ContentHash::addBytes(std::string_view bytes) {
  for (const char byte : bytes) {
    value_ = (value_ ^ static_cast<unsigned char>(byte)) * 0x100000001B3u;
  }
}

ContentHash& ContentHash::add(std::string_view text) {
  addBytes(fmt::format("{}:", text.size()));
  addBytes(text);
  return *this;
}

ContentHash& ContentHash::addFile(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::vector<char> buffer(1 << 16);
  std::uintmax_t size = 0;
  while (file) {
    file.read(buffer.data(), static_cast<std::streamsize>(buffer.size()));
    const auto count = static_cast<std::size_t>(file.gcount());
    addBytes({buffer.data(), count});
    size += count;
  }
  if (!file.eof()) throw Error("file " + path.string() + ": cannot be read; is it there?");
  addBytes(fmt::format(":{}", size));
  return *this;
}

ContentHash& ContentHash::addFolder(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) files.push_back(entry.path().lexically_relative(folder));
  }
  std::sort(files.begin(), files.end());
  for (const fs::path& file : files) add(file.generic_string()).addFile(folder / file);
  return *this;
}

std::string ContentHash::text() const { return fmt::format("{:016x}", value_); }

}  // namespace rangepose::gate
