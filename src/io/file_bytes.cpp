#include "io/file_bytes.h"

#include <fmt/format.h>

#include <fstream>
#include <system_error>

#include "core/error.h"

namespace rangepose {

namespace fs = std::filesystem;

std::string fileLabel(std::string_view what, const fs::path& path) {
  return fmt::format("{} {}", what, path.string());
}

std::uintmax_t checkReadableFile(const fs::path& path,
                                 std::string_view what,
                                 std::uintmax_t max_bytes) {
  const std::string label = fileLabel(what, path);
  std::error_code failure;
  const fs::file_status status = fs::status(path, failure);
  if (!fs::exists(status)) throw Error(label + ": no such file; check the path");
  if (!fs::is_regular_file(status)) throw Error(label + ": not a regular file; name a file");
  const std::uintmax_t size = fs::file_size(path, failure);
  if (failure) throw Error(fmt::format("{}: cannot be read ({})", label, failure.message()));
  if (size == 0) throw Error(label + ": the file is empty; write it again");
  if (size > max_bytes) {
    throw Error(fmt::format(
        "{}: {} bytes are more than the limit of {}; give a smaller file", label, size, max_bytes));
  }
  return size;
}

std::string readFileBytes(const fs::path& path, std::string_view what, std::uintmax_t max_bytes) {
  const std::uintmax_t size = checkReadableFile(path, what, max_bytes);
  std::ifstream file(path, std::ios::binary);
  std::string bytes(static_cast<std::size_t>(size), '\0');
  file.read(bytes.data(), static_cast<std::streamsize>(size));
  if (!file) throw Error(fileLabel(what, path) + ": cannot be read; check its permissions");
  return bytes;
}

std::string oneLine(std::string_view text) {
  constexpr std::size_t kMaxBytes = 200;
  std::string line(text.substr(0, kMaxBytes));
  for (char& character : line) {
    if (static_cast<unsigned char>(character) < 0x20 || character == 0x7f) character = ' ';
  }
  while (!line.empty() && line.back() == ' ') line.pop_back();
  return line;
}

}  // namespace rangepose
