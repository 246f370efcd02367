// Decoders of depth images, from bytes to stored values. Nothing is scaled or removed here.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "core/image.h"

namespace rangepose {

/// Throws Error naming `where` unless 0 < width, height and width * height <= kMaxImagePixels.
void checkImageSize(std::int64_t width, std::int64_t height, const std::string& where);

/// 16-bit grey PNG.
Image<float> decodeDepthPng(std::string_view bytes, const std::string& where);
std::string encodeDepthPng(const Image<std::uint16_t>& values);

/// 16-bit unsigned or 32-bit float TIFF with one sample a pixel, in strips or tiles; first page.
Image<float> decodeDepthTiff(std::string_view bytes, const std::string& where);

/// EXR with one channel of half, float or whole numbers (or one named Z or Depth beside others).
Image<float> decodeDepthExr(std::string_view bytes, const std::string& where);

}  // namespace rangepose
