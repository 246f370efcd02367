// Output files are written whole or not at all.
#pragma once

#include <filesystem>
#include <string_view>

namespace rangepose {

/// Writes the bytes to a temporary file beside `path` and renames it, so that a reader never sees
/// half a file and a failure leaves an older file as it was. A symbolic link is followed; devices
/// and pipes are written directly. Throws Error when the folder is missing or not writable.
void writeFileAtomically(const std::filesystem::path& path, std::string_view bytes);

}  // namespace rangepose
