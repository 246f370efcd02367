#include "rangepose/console.h"

#include <unistd.h>

#include <iostream>
#include <system_error>

#include "core/error.h"

namespace rangepose::cli {
namespace {

/// The whole text, but without control characters.
std::string singleLine(std::string text) {
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
  }
  while (!text.empty() && text.back() == ' ') text.pop_back();
  return text;
}

}  // namespace

void printError(const std::string& text) {
  std::cout.flush();
  std::cerr << "rangepose: " + singleLine(text) + "\n" << std::flush;
}

void printWarning(const std::string& text) { printError("warning: " + text); }

void checkOutputFile(const std::filesystem::path& path) {
  namespace fs = std::filesystem;
  std::error_code failure;
  const std::string label = "output file " + path.string();
  if (path.filename().empty() || fs::is_directory(path, failure)) {
    throw Error(label + ": it is a folder; name a file");
  }
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  if (!fs::is_directory(folder, failure)) {
    throw Error(label + ": there is no folder " + folder.string() + "; make it first");
  }
  if (access(folder.c_str(), W_OK) != 0 && !fs::exists(path, failure)) {
    throw Error(label + ": folder " + folder.string() + " is not writable; choose another one");
  }
}

}  // namespace rangepose::cli
