// EXR by OpenEXR, from memory.
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <fmt/format.h>

#include <cstring>
#include <exception>

#include "core/error.h"
#include "io/depth_formats.h"
#include "io/file_bytes.h"

namespace rangepose {
namespace {

class ByteStream : public Imf::IStream {
 public:
  explicit ByteStream(std::string_view bytes) : Imf::IStream("depth"), bytes_(bytes) {}

  bool read(char target[], int count) override {
    if (count < 0 || position_ > bytes_.size() ||
        static_cast<std::size_t>(count) > bytes_.size() - position_) {
      throw Error("the file ends too early");
    }
    std::memcpy(target, bytes_.data() + position_, static_cast<std::size_t>(count));
    position_ += static_cast<std::size_t>(count);
    return position_ < bytes_.size();
  }
  std::uint64_t tellg() override { return position_; }
  void seekg(std::uint64_t position) override { position_ = static_cast<std::size_t>(position); }

 private:
  std::string_view bytes_;
  std::size_t position_ = 0;
};

std::string_view takeText(std::string_view& rest) {
  const std::size_t end = rest.find('\0');
  if (end == std::string_view::npos) throw Error("the header does not end");
  const std::string_view text = rest.substr(0, end);
  rest.remove_prefix(end + 1);
  return text;
}

std::int32_t takeInt(std::string_view& rest) {
  if (rest.size() < 4) throw Error("the header ends too early");
  std::uint32_t value = 0;
  for (unsigned i = 0; i < 4; ++i) {
    value |= std::uint32_t{static_cast<unsigned char>(rest[i])} << (8 * i);
  }
  rest.remove_prefix(4);
  return static_cast<std::int32_t>(value);
}

/// The size limit is checked on the bytes themselves: a reader of OpenEXR takes memory for the
/// whole size as soon as it is made. The header is a list of (name, type, length, value).
void checkSizeInHeader(std::string_view bytes, const std::string& where) {
  constexpr std::size_t kMagicAndVersion = 8;
  if (bytes.size() < kMagicAndVersion) throw Error("the file ends too early");
  std::string_view rest = bytes.substr(kMagicAndVersion);
  for (;;) {
    const std::string_view name = takeText(rest);
    if (name.empty()) throw Error("the header has no dataWindow");
    const std::string_view type = takeText(rest);
    const std::int32_t length = takeInt(rest);
    if (length < 0 || static_cast<std::size_t>(length) > rest.size()) {
      throw Error("the header ends too early");
    }
    if (name == "dataWindow" && type == "box2i") {
      const std::int64_t x0 = takeInt(rest);
      const std::int64_t y0 = takeInt(rest);
      const std::int64_t x1 = takeInt(rest);
      const std::int64_t y1 = takeInt(rest);
      checkImageSize(x1 - x0 + 1, y1 - y0 + 1, where);
      return;
    }
    rest.remove_prefix(static_cast<std::size_t>(length));
  }
}

void checkHeader(const Imf::Header& header, const std::string& where) {
  const Imath::Box2i& data = header.dataWindow();
  checkImageSize(
      std::int64_t{data.max.x} - data.min.x + 1, std::int64_t{data.max.y} - data.min.y + 1, where);
  if (data != header.displayWindow()) {
    throw Error(where +
                ": the EXR has a data window other than its display window; write all pixels");
  }
}

std::string depthChannel(const Imf::Header& header, const std::string& where) {
  std::string names;
  std::string only;
  std::string depth;
  int count = 0;
  for (auto channel = header.channels().begin(); channel != header.channels().end(); ++channel) {
    const std::string name = channel.name();
    const std::string last = name.substr(name.rfind('.') + 1);
    if (last == "Z" || last == "Depth" || last == "depth") depth = name;
    only = name;
    names += (names.empty() ? "" : ", ") + name;
    ++count;
  }
  std::string chosen = count == 1 ? only : depth;
  if (chosen.empty()) {
    throw Error(
        fmt::format("{}: no depth among the EXR channels ({}); give one channel or name it Z",
                    where,
                    oneLine(names)));
  }
  const Imf::Channel& channel = header.channels()[chosen.c_str()];
  if (channel.xSampling != 1 || channel.ySampling != 1) {
    throw Error(where + ": the EXR channel is subsampled; write all pixels");
  }
  return chosen;
}

Image<float> readPixels(std::string_view bytes, const std::string& where) {
  checkSizeInHeader(bytes, where);
  ByteStream stream(bytes);
  Imf::InputFile file(stream);
  checkHeader(file.header(), where);
  const std::string channel = depthChannel(file.header(), where);
  const Imath::Box2i window = file.header().dataWindow();
  Image<float> image(window.max.x - window.min.x + 1, window.max.y - window.min.y + 1);
  Imf::FrameBuffer buffer;
  buffer.insert(channel,
                Imf::Slice::Make(Imf::FLOAT,
                                 image.data(),
                                 window,
                                 sizeof(float),
                                 sizeof(float) * static_cast<std::size_t>(image.width())));
  file.setFrameBuffer(buffer);
  file.readPixels(window.min.y, window.max.y);
  return image;
}

}  // namespace

Image<float> decodeDepthExr(std::string_view bytes, const std::string& where) {
  try {
    return readPixels(bytes, where);
  } catch (const std::exception& failure) {
    const std::string reason = oneLine(failure.what());
    if (reason.starts_with(where)) throw;
    throw Error(where + ": the EXR is damaged or not supported (" + reason + "); write it again");
  }
}

}  // namespace rangepose
