// TIFF by libtiff, from memory and silent.
#include <fmt/format.h>
#include <tiffio.h>

#include <algorithm>
#include <cstdarg>
#include <cstring>
#include <memory>
#include <vector>

#include "core/error.h"
#include "io/depth_formats.h"

namespace rangepose {
namespace {

/// The file as libtiff sees it.
struct ByteSource {
  std::string_view bytes;
  toff_t position = 0;
};

tmsize_t readBytes(thandle_t handle, void* target, tmsize_t count) {
  auto* source = static_cast<ByteSource*>(handle);
  if (count <= 0 || source->position >= source->bytes.size()) return 0;
  const std::size_t left = source->bytes.size() - static_cast<std::size_t>(source->position);
  const std::size_t taken = std::min(left, static_cast<std::size_t>(count));
  std::memcpy(target, source->bytes.data() + source->position, taken);
  source->position += taken;
  return static_cast<tmsize_t>(taken);
}

tmsize_t writeBytes(thandle_t /*handle*/, void* /*source*/, tmsize_t /*count*/) { return 0; }

toff_t seekBytes(thandle_t handle, toff_t offset, int whence) {
  auto* source = static_cast<ByteSource*>(handle);
  if (whence == SEEK_SET) source->position = offset;
  if (whence == SEEK_CUR) source->position += offset;
  if (whence == SEEK_END) source->position = source->bytes.size() + offset;
  return source->position;
}

int closeBytes(thandle_t /*handle*/) { return 0; }

toff_t sizeOfBytes(thandle_t handle) { return static_cast<ByteSource*>(handle)->bytes.size(); }

/// Returning 1 keeps libtiff from calling its global handler, which prints.
int dropMessage(
    TIFF* /*tiff*/, void* /*user*/, const char* /*module*/, const char* /*format*/, va_list) {
  return 1;
}

using TiffHandle = std::unique_ptr<TIFF, decltype(&TIFFClose)>;

TiffHandle openTiff(ByteSource& source) {
  const std::unique_ptr<TIFFOpenOptions, decltype(&TIFFOpenOptionsFree)> options(
      TIFFOpenOptionsAlloc(), &TIFFOpenOptionsFree);
  TIFFOpenOptionsSetErrorHandlerExtR(options.get(), dropMessage, nullptr);
  TIFFOpenOptionsSetWarningHandlerExtR(options.get(), dropMessage, nullptr);
  // "m": no memory mapping, all access goes through the functions above.
  return {TIFFClientOpenExt("depth",
                            "rm",
                            &source,
                            readBytes,
                            writeBytes,
                            seekBytes,
                            closeBytes,
                            sizeOfBytes,
                            nullptr,
                            nullptr,
                            options.get()),
          &TIFFClose};
}

std::uint16_t tag16(TIFF* tiff, std::uint32_t tag) {
  std::uint16_t value = 0;
  TIFFGetFieldDefaulted(tiff, tag, &value);
  return value;
}

/// Bytes of one sample; Error unless the image holds one 16-bit or float value a pixel.
std::size_t checkedSampleBytes(TIFF* tiff, const std::string& where) {
  const std::uint16_t photometric = tag16(tiff, TIFFTAG_PHOTOMETRIC);
  if (tag16(tiff, TIFFTAG_SAMPLESPERPIXEL) != 1 || photometric > PHOTOMETRIC_MINISBLACK) {
    throw Error(where + ": a colour TIFF; give a depth image with one channel");
  }
  if (tag16(tiff, TIFFTAG_ORIENTATION) != ORIENTATION_TOPLEFT) {
    throw Error(where + ": a TIFF that is stored rotated or mirrored; store it upright");
  }
  const std::uint16_t bits = tag16(tiff, TIFFTAG_BITSPERSAMPLE);
  const std::uint16_t format = tag16(tiff, TIFFTAG_SAMPLEFORMAT);
  if (bits == 16 && format == SAMPLEFORMAT_UINT) return 2;
  if (bits == 32 && format == SAMPLEFORMAT_IEEEFP) return 4;
  throw Error(fmt::format(
      "{}: a TIFF with {}-bit samples of format {}; depth needs 16-bit unsigned or 32-bit float",
      where,
      bits,
      format));
}

void copySamples(const unsigned char* source, std::size_t sample_bytes, int count, float* target) {
  for (int i = 0; i < count; ++i, source += sample_bytes) {
    if (sample_bytes == 4) {
      std::memcpy(target + i, source, 4);
    } else {
      std::uint16_t value = 0;
      std::memcpy(&value, source, 2);
      target[i] = value;
    }
  }
}

/// Strips are read as tiles that are as wide as the image.
struct Blocks {
  std::uint32_t width = 0;   ///< [px]
  std::uint32_t height = 0;  ///< [px]
  bool tiled = false;
};

Blocks blockSize(TIFF* tiff, const Image<float>& image, const std::string& where) {
  Blocks blocks;
  blocks.tiled = TIFFIsTiled(tiff) != 0;
  if (blocks.tiled) {
    TIFFGetField(tiff, TIFFTAG_TILEWIDTH, &blocks.width);
    TIFFGetField(tiff, TIFFTAG_TILELENGTH, &blocks.height);
  } else {
    blocks.width = static_cast<std::uint32_t>(image.width());
    TIFFGetFieldDefaulted(tiff, TIFFTAG_ROWSPERSTRIP, &blocks.height);
    blocks.height = std::min(blocks.height, static_cast<std::uint32_t>(image.height()));
  }
  checkImageSize(blocks.width, blocks.height, where + " (its blocks)");
  return blocks;
}

/// False when a block cannot be read.
bool readBlocks(TIFF* tiff, const Blocks& blocks, std::size_t sample_bytes, Image<float>& image) {
  const std::size_t row_bytes = blocks.width * sample_bytes;
  std::vector<unsigned char> buffer(row_bytes * blocks.height);
  const auto capacity = static_cast<tmsize_t>(buffer.size());
  if (blocks.tiled && TIFFTileSize(tiff) != capacity) return false;
  std::uint32_t index = 0;
  for (int y0 = 0; y0 < image.height(); y0 += static_cast<int>(blocks.height)) {
    const int rows = std::min(static_cast<int>(blocks.height), image.height() - y0);
    for (int x0 = 0; x0 < image.width(); x0 += static_cast<int>(blocks.width), ++index) {
      const int columns = std::min(static_cast<int>(blocks.width), image.width() - x0);
      const tmsize_t read = blocks.tiled
                                ? TIFFReadEncodedTile(tiff, index, buffer.data(), capacity)
                                : TIFFReadEncodedStrip(tiff, index, buffer.data(), capacity);
      const auto needed = blocks.tiled ? capacity : static_cast<tmsize_t>(row_bytes) * rows;
      if (read < needed) return false;
      for (int y = 0; y < rows; ++y) {
        copySamples(buffer.data() + static_cast<std::size_t>(y) * row_bytes,
                    sample_bytes,
                    columns,
                    image.row(y0 + y) + x0);
      }
    }
  }
  return true;
}

}  // namespace

Image<float> decodeDepthTiff(std::string_view bytes, const std::string& where) {
  const std::string damaged = where + ": the TIFF is damaged or truncated; write it again";
  ByteSource source{bytes};
  const TiffHandle tiff = openTiff(source);
  if (tiff == nullptr) throw Error(damaged);
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  TIFFGetField(tiff.get(), TIFFTAG_IMAGEWIDTH, &width);
  TIFFGetField(tiff.get(), TIFFTAG_IMAGELENGTH, &height);
  checkImageSize(width, height, where);
  const std::size_t sample_bytes = checkedSampleBytes(tiff.get(), where);
  Image<float> image(static_cast<int>(width), static_cast<int>(height));
  const Blocks blocks = blockSize(tiff.get(), image, where);
  if (!readBlocks(tiff.get(), blocks, sample_bytes, image)) throw Error(damaged);
  return image;
}

}  // namespace rangepose
