#include "io/atomic_file.h"

#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <system_error>

#include "core/error.h"

namespace rangepose {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void failToWrite(const fs::path& path, const std::string& reason) {
  throw Error(fmt::format("output file {}: cannot be written ({}); check folder and permissions",
                          path.string(),
                          reason));
}

/// A name of its own for each write, so that two writers of one path do not meet.
fs::path temporaryBeside(const fs::path& path) {
  static std::atomic<unsigned> counter{0};
  return path.parent_path() /
         fmt::format(".{}.{}.{}.tmp", path.filename().string(), getpid(), counter++);
}

/// Empty when all bytes have reached the file, else the reason.
std::string writeBytes(const fs::path& path, std::string_view bytes) {
  errno = 0;
  std::ofstream file(path, std::ios::binary | std::ios::trunc);
  if (file) file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (file) file.close();
  if (file) return {};
  return errno != 0 ? std::strerror(errno) : "write error";
}

}  // namespace

void writeFileAtomically(const fs::path& path, std::string_view bytes) {
  if (path.filename().empty()) failToWrite(path, "no file name");
  std::error_code failure;
  fs::path target = path;
  if (fs::is_symlink(path, failure) && fs::exists(path, failure)) {
    target = fs::canonical(path, failure);
    if (failure) failToWrite(path, failure.message());
  }
  if (fs::is_directory(target, failure)) failToWrite(path, "it is a folder");
  if (fs::exists(target, failure) && !fs::is_regular_file(target, failure)) {
    const std::string reason = writeBytes(target, bytes);
    if (!reason.empty()) failToWrite(path, reason);
    return;
  }

  const fs::path temporary = temporaryBeside(target);
  std::string reason = writeBytes(temporary, bytes);
  if (reason.empty()) {
    fs::rename(temporary, target, failure);
    if (!failure) return;
    reason = failure.message();
  }
  fs::remove(temporary, failure);
  failToWrite(path, reason);
}

}  // namespace rangepose
