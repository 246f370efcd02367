// Decompression of LZF, the compression inside of PCD files.
#pragma once

#include <string>
#include <string_view>

namespace rangepose {

/// Expands `packed` to exactly `size` bytes. Throws Error naming `where` when the data is damaged
/// or gives another size.
std::string expandLzf(std::string_view packed, std::size_t size, const std::string& where);

}  // namespace rangepose
