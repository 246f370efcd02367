// Reading whole files, and making one line of the messages of other libraries.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace rangepose {

/// How a file is named in messages: `what` and its path, e.g. "depth image a/b.png".
std::string fileLabel(std::string_view what, const std::filesystem::path& path);

/// All bytes of a regular file. Throws Error when it is missing, unreadable, empty, not a file or
/// larger than `max_bytes`.
std::string readFileBytes(const std::filesystem::path& path,
                          std::string_view what,
                          std::uintmax_t max_bytes);

/// Throws the errors of readFileBytes without reading; returns the size [bytes].
std::uintmax_t checkReadableFile(const std::filesystem::path& path,
                                 std::string_view what,
                                 std::uintmax_t max_bytes);

/// The text with control characters turned into spaces, at most 200 bytes of it.
std::string oneLine(std::string_view text);

}  // namespace rangepose
