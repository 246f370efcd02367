#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <optional>
#include <string_view>
#include <utility>

#include "core/error.h"
#include "io/atomic_file.h"
#include "io/bop.h"
#include "io/file_bytes.h"
#include "io/json_fields.h"
#include "io/text_scan.h"

namespace rangepose {
namespace {

std::string number(double value, const BopEstimate& row) {
  if (!std::isfinite(value)) {
    throw Error(fmt::format("BOP result of scene {} image {} object {}: a value is not finite",
                            row.scene_id,
                            row.im_id,
                            row.obj_id));
  }
  return fmt::format("{:.9g}", value + 0.0);  // + 0.0: no "-0"
}

constexpr std::string_view kHeader = "scene_id,im_id,obj_id,score,R,t,time";
constexpr std::size_t kColumns = 7;

std::vector<std::string_view> columnsOf(std::string_view line) {
  std::vector<std::string_view> columns;
  for (std::size_t comma = line.find(','); comma != std::string_view::npos;
       comma = line.find(',')) {
    columns.push_back(line.substr(0, comma));
    line.remove_prefix(comma + 1);
  }
  columns.push_back(line);
  return columns;
}

/// The only word of a column; what is no word of its own stays as it is.
std::string_view trimmed(std::string_view column) {
  std::string_view rest = column;
  const std::string_view word = takeWord(rest);
  return takeWord(rest).empty() ? word : column;
}

int idOf(std::string_view column, const char* name, const std::string& where) {
  const std::optional<long long> id = parseCount(trimmed(column));
  if (id && *id <= std::numeric_limits<int>::max()) return static_cast<int>(*id);
  throw Error(fmt::format("{}: {} \"{}\" is no whole number", where, name, oneLine(column)));
}

double finite(std::string_view column, const char* name, const std::string& where) {
  const std::optional<double> value = parseNumber(trimmed(column));
  if (value && std::isfinite(*value)) return *value;
  throw Error(fmt::format("{}: {} \"{}\" is no finite number", where, name, oneLine(column)));
}

std::vector<double> finiteWords(std::string_view column,
                                std::size_t count,
                                const char* name,
                                const std::string& where) {
  std::vector<double> values;
  for (const std::string& word : wordsOf(column)) values.push_back(finite(word, name, where));
  if (values.size() == count) return values;
  throw Error(fmt::format("{}: {} has {} numbers, must have {} with spaces between them",
                          where,
                          name,
                          values.size(),
                          count));
}

BopEstimate rowOf(std::string_view line, const std::string& where) {
  const std::vector<std::string_view> columns = columnsOf(line);
  if (columns.size() != kColumns) {
    throw Error(
        fmt::format("{}: {} columns, must be {} ({})", where, columns.size(), kColumns, kHeader));
  }
  BopEstimate row;
  row.scene_id = idOf(columns[0], "scene_id", where);
  row.im_id = idOf(columns[1], "im_id", where);
  row.obj_id = idOf(columns[2], "obj_id", where);
  row.score = finite(columns[3], "score", where);
  row.camera_from_object.rotation =
      rotationFromRows(finiteWords(columns[4], 9, "R", where), where + ": R");
  const std::vector<double> t = finiteWords(columns[5], 3, "t", where);
  row.camera_from_object.translation_mm = {t[0], t[1], t[2]};
  row.time_s = finite(columns[6], "time", where);
  return row;
}

}  // namespace

std::string bopCsv(const std::vector<BopEstimate>& estimates) {
  std::string text = std::string(kHeader) + "\n";
  std::map<std::pair<int, int>, double> time_of_image;
  for (const BopEstimate& row : estimates) {
    const auto [known, is_new] = time_of_image.try_emplace({row.scene_id, row.im_id}, row.time_s);
    if (!is_new && known->second != row.time_s) {
      throw Error(fmt::format(
          "BOP results of scene {} image {}: rows with different times", row.scene_id, row.im_id));
    }
    fmt::format_to(std::back_inserter(text),
                   "{},{},{},{},",
                   row.scene_id,
                   row.im_id,
                   row.obj_id,
                   number(row.score, row));
    const Pose& pose = row.camera_from_object;
    for (int i = 0; i < 9; ++i) {
      text += number(pose.rotation[i % 3][i / 3], row);
      text += i < 8 ? ' ' : ',';
    }
    for (int i = 0; i < 3; ++i) {
      text += number(pose.translation_mm[i], row);
      text += i < 2 ? ' ' : ',';
    }
    text += number(row.time_s, row) + "\n";
  }
  return text;
}

void writeBopCsv(const std::filesystem::path& path, const std::vector<BopEstimate>& estimates) {
  writeFileAtomically(path, bopCsv(estimates));
}

std::vector<BopEstimate> readBopCsv(const std::filesystem::path& path) {
  constexpr std::uintmax_t kMaxBytes = std::uintmax_t{1} << 30;
  const std::string text = readFileBytes(path, "result file", kMaxBytes);
  const std::string label = fileLabel("result file", path);
  std::string_view rest = text;
  if (trimmed(takeLine(rest)) != kHeader) {
    throw Error(fmt::format("{}: line 1 must be {}", label, kHeader));
  }
  std::vector<BopEstimate> rows;
  std::map<std::pair<int, int>, double> time_of_image;
  for (int number_of_line = 2; !rest.empty(); ++number_of_line) {
    const std::string_view line = takeLine(rest);
    if (wordsOf(line).empty()) continue;
    const std::string where = fmt::format("{}: line {}", label, number_of_line);
    rows.push_back(rowOf(line, where));
    const BopEstimate& row = rows.back();
    const auto [known, is_new] = time_of_image.try_emplace({row.scene_id, row.im_id}, row.time_s);
    if (!is_new && known->second != row.time_s) {
      throw Error(fmt::format("{}: the time of scene {} image {} differs from the rows above",
                              where,
                              row.scene_id,
                              row.im_id));
    }
  }
  return rows;
}

}  // namespace rangepose
