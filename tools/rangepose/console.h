// What the program says on stderr, and the check of output files before the work.
#pragma once

#include <filesystem>
#include <string>

namespace rangepose::cli {

/// "rangepose: text", one line.
void printError(const std::string& text);

/// "rangepose: warning: text", one line.
void printWarning(const std::string& text);

/// Throws Error when the folder of `path` is missing or not writable, or `path` is a folder: better
/// before minutes of work than after.
void checkOutputFile(const std::filesystem::path& path);

}  // namespace rangepose::cli
