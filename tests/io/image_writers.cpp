#include "io/image_writers.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <half.h>
#include <png.h>
#include <tiffio.h>

#include <algorithm>
#include <cstring>
#include <stdexcept>

#include "io/io_support.h"

namespace rangepose::test {

std::string makePng(
    int width, int height, int channels, int bits, const std::vector<std::uint16_t>& values) {
  std::string bytes;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  png_set_write_fn(
      png,
      &bytes,
      [](png_structp self, png_bytep data, std::size_t count) {
        static_cast<std::string*>(png_get_io_ptr(self))
            ->append(reinterpret_cast<const char*>(data), count);
      },
      [](png_structp) {});
  png_set_IHDR(png,
               info,
               static_cast<png_uint_32>(width),
               static_cast<png_uint_32>(height),
               bits,
               channels == 1 ? PNG_COLOR_TYPE_GRAY : PNG_COLOR_TYPE_RGB,
               PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT,
               PNG_FILTER_TYPE_DEFAULT);
  png_write_info(png, info);
  std::size_t next = 0;
  for (int y = 0; y < height; ++y) {
    std::string row;
    for (int i = 0; i < width * channels; ++i) {
      const std::uint16_t value = values[next++];
      row += bits == 16 ? rawBytes(value, true) : rawBytes(static_cast<std::uint8_t>(value));
    }
    png_write_row(png, reinterpret_cast<png_const_bytep>(row.data()));
  }
  png_write_end(png, info);
  png_destroy_write_struct(&png, &info);
  return bytes;
}

namespace {

std::string tiffSample(const TiffLayout& layout, float value) {
  if (layout.is_float && layout.bits == 64) return rawBytes(static_cast<double>(value));
  if (layout.is_float) return rawBytes(value);
  if (layout.bits == 8) return rawBytes(static_cast<std::uint8_t>(value));
  return rawBytes(static_cast<std::uint16_t>(value));
}

void writeTiles(
    TIFF* tiff, int width, int height, const TiffLayout& layout, const std::vector<float>& values) {
  constexpr int kSide = 16;
  TIFFSetField(tiff, TIFFTAG_TILEWIDTH, kSide);
  TIFFSetField(tiff, TIFFTAG_TILELENGTH, kSide);
  for (int y0 = 0; y0 < height; y0 += kSide) {
    for (int x0 = 0; x0 < width; x0 += kSide) {
      std::string tile;
      for (int i = 0; i < kSide * kSide; ++i) {
        const int x = std::min(x0 + i % kSide, width - 1);
        const int y = std::min(y0 + i / kSide, height - 1);
        tile += tiffSample(layout,
                           values.at(static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                                     static_cast<std::size_t>(x)));
      }
      TIFFWriteTile(
          tiff, tile.data(), static_cast<std::uint32_t>(x0), static_cast<std::uint32_t>(y0), 0, 0);
    }
  }
}

}  // namespace

std::string makeTiff(int width,
                     int height,
                     const TiffLayout& layout,
                     const std::vector<float>& values) {
  const TempFolder folder;
  const std::string path = (folder.path() / "image.tif").string();
  TIFF* tiff = TIFFOpen(path.c_str(), layout.big_endian ? "wb" : "wl");
  if (tiff == nullptr) throw std::runtime_error("no TIFF");
  TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, width);
  TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, height);
  TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, layout.bits);
  TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, layout.channels);
  TIFFSetField(
      tiff, TIFFTAG_SAMPLEFORMAT, layout.is_float ? SAMPLEFORMAT_IEEEFP : SAMPLEFORMAT_UINT);
  TIFFSetField(tiff, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
  TIFFSetField(
      tiff, TIFFTAG_PHOTOMETRIC, layout.channels == 1 ? PHOTOMETRIC_MINISBLACK : PHOTOMETRIC_RGB);
  TIFFSetField(
      tiff, TIFFTAG_COMPRESSION, layout.compressed ? COMPRESSION_ADOBE_DEFLATE : COMPRESSION_NONE);
  if (layout.tiled) {
    writeTiles(tiff, width, height, layout, values);
  } else {
    TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, 5);
    std::size_t next = 0;
    for (int y = 0; y < height; ++y) {
      std::string row;
      for (int i = 0; i < width * layout.channels; ++i) {
        row += tiffSample(layout, values.at(next++));
      }
      TIFFWriteScanline(tiff, row.data(), static_cast<std::uint32_t>(y), 0);
    }
  }
  TIFFClose(tiff);
  return bytesOf(path);
}

std::string makeExr(int width,
                    int height,
                    const std::vector<std::string>& channels,
                    const std::vector<float>& values,
                    bool half_floats) {
  const TempFolder folder;
  const std::string path = (folder.path() / "image.exr").string();
  std::vector<half> halves(values.begin(), values.end());
  Imf::Header header(width, height);
  Imf::FrameBuffer buffer;
  const auto columns = static_cast<std::size_t>(width);
  for (const std::string& name : channels) {
    const Imf::PixelType type = half_floats ? Imf::HALF : Imf::FLOAT;
    header.channels().insert(name, Imf::Channel(type));
    char* data = half_floats ? reinterpret_cast<char*>(halves.data())
                             : reinterpret_cast<char*>(const_cast<float*>(values.data()));
    const std::size_t size = half_floats ? sizeof(half) : sizeof(float);
    buffer.insert(name, Imf::Slice(type, data, size, size * columns));
  }
  {
    Imf::OutputFile file(path.c_str(), header);
    file.setFrameBuffer(buffer);
    file.writePixels(height);
  }
  return bytesOf(path);
}

}  // namespace rangepose::test
