#include "rangepose/bop_journal.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <optional>
#include <string_view>
#include <system_error>

#include "core/byte_stream.h"
#include "core/error.h"
#include "io/atomic_file.h"
#include "io/bop.h"
#include "io/file_bytes.h"
#include "io/text_scan.h"

namespace rangepose::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* kWhat = "results so far";
constexpr const char* kRemedy = "delete it to start anew";

/// A block: a line with a label, the number of lines that follow, and the checksum of label and
/// lines; then those lines.
struct Block {
  std::string label;
  std::string body;
};

std::string textOf(const Block& block) {
  const std::string all = block.label + "\n" + block.body;
  const auto lines = std::count(block.body.begin(), block.body.end(), '\n');
  return fmt::format(
      "{} : {} {:016x}\n{}", block.label, lines, checksum(all.data(), all.size()), block.body);
}

/// Takes `lines` whole lines off the front; empty where there are fewer.
std::optional<std::string_view> takeLines(std::string_view& rest, long long lines) {
  std::size_t end = 0;
  for (long long i = 0; i < lines; ++i) {
    const std::size_t line_end = rest.find('\n', end);
    if (line_end == std::string_view::npos) return std::nullopt;
    end = line_end + 1;
  }
  const std::string_view taken = rest.substr(0, end);
  rest.remove_prefix(end);
  return taken;
}

/// Takes a block off the front of `rest`; empty where the text ends before the block does. Throws
/// Error for a block that is not as it was written.
std::optional<Block> takeBlock(std::string_view& rest, const std::string& where) {
  std::string_view left = rest;
  const std::optional<std::string_view> head = takeLines(left, 1);
  if (!head) return std::nullopt;
  const std::size_t colon = head->rfind(" : ");
  const std::vector<std::string> words =
      colon == std::string_view::npos ? std::vector<std::string>() : wordsOf(head->substr(colon));
  const std::optional<long long> lines =
      words.size() == 3 ? parseCount(words[1]) : std::optional<long long>();
  if (!lines) throw Error(fmt::format("{}: damaged; {}", where, kRemedy));
  const std::optional<std::string_view> body = takeLines(left, *lines);
  if (!body) return std::nullopt;
  const Block block{std::string(head->substr(0, colon)), std::string(*body)};
  if (textOf(block) != std::string(*head) + std::string(*body)) {
    throw Error(fmt::format("{}: damaged at \"{}\"; {}", where, oneLine(block.label), kRemedy));
  }
  rest = left;
  return block;
}

constexpr const char* kRunLabel = "rangepose estimate --bop, format 1";

Block blockOf(const RunFacts& facts) {
  Block block{kRunLabel, {}};
  for (const auto& [name, value] : facts) block.body += name + " = " + oneLine(value) + "\n";
  return block;
}

/// Names the first fact that differs.
void checkRun(const Block& there, const RunFacts& facts, const std::string& where) {
  const Block here = blockOf(facts);
  if (there.label != here.label) {
    throw Error(fmt::format("{}: of another version of rangepose; {}", where, kRemedy));
  }
  std::string_view theirs = there.body;
  std::string_view ours = here.body;
  while (!theirs.empty() || !ours.empty()) {
    const std::string_view was = takeLine(theirs);
    const std::string_view is = takeLine(ours);
    if (was == is) continue;
    throw Error(
        fmt::format("{}: of a run with other settings (then {}, now {}); give the same "
                    "ones, or {}",
                    where,
                    oneLine(was),
                    oneLine(is),
                    kRemedy));
  }
}

Block blockOf(const ImageKey& key, const DoneImage& image) {
  return {fmt::format("image {} {} {:.9g}", key.first, key.second, image.time_s), image.rows};
}

std::pair<ImageKey, DoneImage> imageOf(const Block& block, const std::string& where) {
  const std::vector<std::string> words = wordsOf(block.label);
  if (words.size() == 4 && words[0] == "image") {
    const std::optional<long long> scene = parseCount(words[1]);
    const std::optional<long long> image = parseCount(words[2]);
    const std::optional<double> time_s = parseNumber(words[3]);
    if (scene && image && time_s) {
      const auto poses = std::count(block.body.begin(), block.body.end(), '\n');
      return {{static_cast<int>(*scene), static_cast<int>(*image)},
              {*time_s, static_cast<int>(poses), block.body}};
    }
  }
  throw Error(fmt::format("{}: damaged at \"{}\"; {}", where, oneLine(block.label), kRemedy));
}

bool isDevice(const fs::path& path) {
  std::error_code failure;
  return fs::exists(path, failure) && !fs::is_regular_file(path, failure);
}

}  // namespace

BopJournal::BopJournal(const fs::path& csv, const RunFacts& facts, bool resume) : csv_(csv) {
  if (isDevice(csv)) return;
  side_file_ = csv.string() + ".partial";
  std::error_code failure;
  if (fs::exists(side_file_, failure)) {
    if (!resume) {
      throw Error(
          fmt::format("{}: a run that was interrupted has left it; go on with it by "
                      "--resume, or {}",
                      fileLabel(kWhat, side_file_),
                      kRemedy));
    }
    read(facts);
  }
  if (!fs::exists(side_file_, failure)) writeFileAtomically(side_file_, textOf(blockOf(facts)));
}

void BopJournal::read(const RunFacts& facts) {
  constexpr std::uintmax_t kMaxBytes = std::uintmax_t{1} << 31;
  const std::string where = fileLabel(kWhat, side_file_);
  const std::string text = readFileBytes(side_file_, kWhat, kMaxBytes);
  std::string_view rest = text;
  const std::optional<Block> run = takeBlock(rest, where);
  if (!run) throw Error(fmt::format("{}: damaged; {}", where, kRemedy));
  checkRun(*run, facts, where);
  while (const std::optional<Block> block = takeBlock(rest, where)) {
    done_.insert(imageOf(*block, where));
  }
  // The end of a block that was not written to its end would spoil the next one.
  std::error_code failure;
  fs::resize_file(side_file_, text.size() - rest.size(), failure);
  if (failure) {
    throw Error(fmt::format("{}: cannot be written ({})", where, failure.message()));
  }
}

void BopJournal::append(const std::string& block) {
  if (side_file_.empty()) return;
  errno = 0;
  std::ofstream file(side_file_, std::ios::binary | std::ios::app);
  file.write(block.data(), static_cast<std::streamsize>(block.size()));
  file.close();
  if (file) return;
  throw Error(fmt::format("{}: cannot be written ({}); make room and go on by --resume",
                          fileLabel(kWhat, side_file_),
                          errno != 0 ? std::strerror(errno) : "write error"));
}

void BopJournal::add(const ImageKey& key, DoneImage image) {
  append(textOf(blockOf(key, image)));
  done_.insert_or_assign(key, std::move(image));
}

void BopJournal::finish() {
  std::string text = bopCsv({});
  for (const auto& [key, image] : done_) text += image.rows;
  writeFileAtomically(csv_, text);
  std::error_code ignored;
  if (!side_file_.empty()) fs::remove(side_file_, ignored);
}

}  // namespace rangepose::cli
