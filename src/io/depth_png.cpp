// PNG by libpng, silent: its errors become Error, its warnings are dropped.
//
// libpng leaves a failed call by longjmp. The functions that it may leave this way own nothing:
// what they work on belongs to their caller.
#include <fmt/format.h>
#include <png.h>

#include <array>
#include <bit>
#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <vector>

#include "core/error.h"
#include "io/depth_formats.h"
#include "io/file_bytes.h"

namespace rangepose {
namespace {

struct Failure {
  std::array<char, 128> text{};
};

void onError(png_structp png, png_const_charp message) {
  auto* failure = static_cast<Failure*>(png_get_error_ptr(png));
  std::snprintf(failure->text.data(), failure->text.size(), "%s", message);
  png_longjmp(png, 1);
}

void onWarning(png_structp /*png*/, png_const_charp /*message*/) {}

void readBytes(png_structp png, png_bytep target, std::size_t count) {
  auto* rest = static_cast<std::string_view*>(png_get_io_ptr(png));
  if (count > rest->size()) png_error(png, "the file ends too early");
  std::memcpy(target, rest->data(), count);
  rest->remove_prefix(count);
}

void writeBytes(png_structp png, png_bytep source, std::size_t count) {
  auto* bytes = static_cast<std::string*>(png_get_io_ptr(png));
  bytes->append(reinterpret_cast<const char*>(source), count);
}

void flushBytes(png_structp /*png*/) {}

struct Reader {
  Reader() {
    png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &failure, onError, onWarning);
    info = png != nullptr ? png_create_info_struct(png) : nullptr;
    RP_CHECK(info != nullptr, "libpng: cannot be started");
  }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;
  ~Reader() { png_destroy_read_struct(&png, &info, nullptr); }

  Failure failure;
  png_structp png = nullptr;
  png_infop info = nullptr;
};

struct Writer {
  Writer() {
    png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &failure, onError, onWarning);
    info = png != nullptr ? png_create_info_struct(png) : nullptr;
    RP_CHECK(info != nullptr, "libpng: cannot be started");
  }
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;
  ~Writer() { png_destroy_write_struct(&png, &info); }

  Failure failure;
  png_structp png = nullptr;
  png_infop info = nullptr;
};

bool readHeader(const Reader& reader) {
  if (setjmp(png_jmpbuf(reader.png)) != 0) return false;
  png_read_info(reader.png, reader.info);
  return true;
}

bool readRows(const Reader& reader, png_bytepp rows) {
  if (setjmp(png_jmpbuf(reader.png)) != 0) return false;
  if constexpr (std::endian::native == std::endian::little) png_set_swap(reader.png);
  png_read_image(reader.png, rows);
  png_read_end(reader.png, nullptr);
  return true;
}

bool writeImage(const Writer& writer, png_uint_32 width, png_uint_32 height, png_bytepp rows) {
  if (setjmp(png_jmpbuf(writer.png)) != 0) return false;
  png_set_IHDR(writer.png,
               writer.info,
               width,
               height,
               16,
               PNG_COLOR_TYPE_GRAY,
               PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT,
               PNG_FILTER_TYPE_DEFAULT);
  png_write_info(writer.png, writer.info);
  if constexpr (std::endian::native == std::endian::little) png_set_swap(writer.png);
  png_write_image(writer.png, rows);
  png_write_end(writer.png, nullptr);
  return true;
}

std::vector<png_bytep> rowPointers(Image<std::uint16_t>& image) {
  std::vector<png_bytep> rows;
  rows.reserve(static_cast<std::size_t>(image.height()));
  for (int y = 0; y < image.height(); ++y)
    rows.push_back(reinterpret_cast<png_bytep>(image.row(y)));
  return rows;
}

[[noreturn]] void failDamaged(const std::string& where, const Failure& failure) {
  throw Error(fmt::format("{}: the PNG is damaged or truncated ({}); write it again",
                          where,
                          oneLine(failure.text.data())));
}

}  // namespace

Image<float> decodeDepthPng(std::string_view bytes, const std::string& where) {
  Reader reader;
  png_set_read_fn(reader.png, &bytes, readBytes);
  if (!readHeader(reader)) failDamaged(where, reader.failure);
  const png_uint_32 width = png_get_image_width(reader.png, reader.info);
  const png_uint_32 height = png_get_image_height(reader.png, reader.info);
  checkImageSize(width, height, where);
  if (png_get_color_type(reader.png, reader.info) != PNG_COLOR_TYPE_GRAY) {
    throw Error(where + ": a colour PNG; give a depth image with one 16-bit channel");
  }
  if (const int bits = png_get_bit_depth(reader.png, reader.info); bits != 16) {
    throw Error(fmt::format("{}: a {}-bit PNG; depth needs 16 bits", where, bits));
  }
  Image<std::uint16_t> values(static_cast<int>(width), static_cast<int>(height));
  std::vector<png_bytep> rows = rowPointers(values);
  if (!readRows(reader, rows.data())) failDamaged(where, reader.failure);
  Image<float> result(values.width(), values.height());
  for (std::size_t i = 0; i < values.size(); ++i) result.data()[i] = values.data()[i];
  return result;
}

std::string encodeDepthPng(const Image<std::uint16_t>& values) {
  Writer writer;
  std::string bytes;
  png_set_write_fn(writer.png, &bytes, writeBytes, flushBytes);
  Image<std::uint16_t> copy = values;  // libpng takes rows as mutable
  std::vector<png_bytep> rows = rowPointers(copy);
  if (!writeImage(writer,
                  static_cast<png_uint_32>(values.width()),
                  static_cast<png_uint_32>(values.height()),
                  rows.data())) {
    throw Error(fmt::format("PNG: cannot be written ({})", oneLine(writer.failure.text.data())));
  }
  return bytes;
}

}  // namespace rangepose
