#include "io/pcd_header.h"

#include <fmt/format.h>

#include <optional>
#include <utility>

#include "core/error.h"
#include "io/file_bytes.h"
#include "io/text_scan.h"

namespace rangepose {
namespace {

constexpr long long kMaxPoints = 100'000'000;
constexpr long long kMaxFieldBytes = 1 << 20;

class HeaderParser {
 public:
  explicit HeaderParser(const std::string& where) : where_(where) {}

  PcdHeader parse(std::string_view& rest) {
    while (header_.data.empty()) {
      if (rest.empty()) fail("has no DATA line; the file is truncated or no PCD");
      const std::vector<std::string> words = wordsOf(takeLine(rest));
      if (words.empty() || words[0][0] == '#') continue;
      parseLine(words);
    }
    finishFields();
    finishCounts();
    return std::move(header_);
  }

 private:
  [[noreturn]] void fail(const std::string& problem) const {
    throw Error(where_ + ": the PCD header " + problem);
  }

  void parseLine(const std::vector<std::string>& words) {
    const std::string& key = words[0];
    if (key == "FIELDS" || key == "COLUMNS") {
      for (std::size_t i = 1; i < words.size(); ++i) header_.fields.push_back({words[i]});
    } else if (key == "SIZE") {
      forEachField(words, [&](PcdField& field, const std::string& word) {
        field.size = parseCount(word).value_or(0);
        if (field.size != 1 && field.size != 2 && field.size != 4 && field.size != 8) {
          fail("has a SIZE other than 1, 2, 4 or 8");
        }
      });
    } else if (key == "TYPE") {
      forEachField(words, [&](PcdField& field, const std::string& word) {
        if (word != "F" && word != "I" && word != "U") fail("has a TYPE other than F, I or U");
        field.type = word[0];
      });
    } else if (key == "COUNT") {
      forEachField(words, [&](PcdField& field, const std::string& word) {
        field.count = parseCount(word).value_or(-1);
        if (field.count < 0 || field.count > kMaxFieldBytes) fail("has a bad COUNT");
      });
    } else if (key == "WIDTH") {
      header_.width = wholeNumber(words);
    } else if (key == "HEIGHT") {
      header_.height = wholeNumber(words);
    } else if (key == "POINTS") {
      header_.points = wholeNumber(words);
    } else if (key == "DATA") {
      header_.data = words.size() == 2 ? words[1] : "?";
    } else if (key != "VERSION" && key != "VIEWPOINT") {
      fail("has a line that is not understood: " + oneLine(key.substr(0, 40)));
    }
  }

  template <typename Setter>
  void forEachField(const std::vector<std::string>& words, const Setter& set) {
    if (words.size() != header_.fields.size() + 1) {
      fail(fmt::format(
          "has {} values in {} for {} FIELDS", words.size() - 1, words[0], header_.fields.size()));
    }
    for (std::size_t i = 1; i < words.size(); ++i) set(header_.fields[i - 1], words[i]);
  }

  long long wholeNumber(const std::vector<std::string>& words) const {
    const std::optional<long long> value = words.size() == 2 ? parseCount(words[1]) : std::nullopt;
    if (!value) fail("has a " + words[0] + " that is no whole number");
    return *value;
  }

  void finishFields() {
    for (PcdField& field : header_.fields) {
      field.offset = header_.point_bytes;
      header_.point_bytes += field.bytes();
    }
    const std::string names = "xyz";
    for (std::size_t axis = 0; axis < 3; ++axis) {
      std::size_t index = 0;
      while (index < header_.fields.size() && header_.fields[index].name != names.substr(axis, 1)) {
        ++index;
      }
      if (index == header_.fields.size()) {
        fail(fmt::format("has no field {}; it needs x, y and z", names[axis]));
      }
      const PcdField& field = header_.fields[index];
      if (field.type != 'F' || field.size < 4 || field.count != 1) {
        fail(fmt::format("has a field {} that is not one float or double", names[axis]));
      }
      header_.axes[axis] = index;
    }
  }

  void finishCounts() {
    // A file from before version 0.5 has POINTS alone.
    if (header_.width == 0 && header_.height == 0 && header_.points > 0) {
      header_.width = header_.points;
      header_.height = 1;
    }
    if (header_.width <= 0 || header_.height <= 0 || header_.width > kMaxPoints ||
        header_.height > kMaxPoints / header_.width) {
      fail(fmt::format("has WIDTH {} and HEIGHT {}; 1 to {} points are supported",
                       header_.width,
                       header_.height,
                       kMaxPoints));
    }
    const long long product = header_.width * header_.height;
    if (header_.points >= 0 && header_.points != product) {
      fail(fmt::format("has POINTS {}, but WIDTH x HEIGHT is {}", header_.points, product));
    }
    header_.points = product;
  }

  const std::string& where_;
  PcdHeader header_;
};

}  // namespace

PcdHeader takePcdHeader(std::string_view& rest, const std::string& where) {
  return HeaderParser(where).parse(rest);
}

}  // namespace rangepose
