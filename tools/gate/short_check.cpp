#include "gate/short_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/error.h"
#include "gate/strict_json.h"
#include "io/file_bytes.h"
#include "io/json_fields.h"

namespace rangepose::gate {
namespace {

using nlohmann::json;
using Json = nlohmann::ordered_json;

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
constexpr std::uintmax_t kMaxBytes = 1 << 20;
constexpr double kSameNumber = 5e-7;  ///< figures are recorded with six decimals

enum class Wanted { kHigh, kLow, kSame };

struct CheckedFigure {
  const char* key;
  Wanted wanted;
};

constexpr CheckedFigure kChecked[] = {
    {"images", Wanted::kSame},
    {"parts", Wanted::kSame},
    {"first_pick", Wanted::kHigh},
    {"recall", Wanted::kHigh},
    {"precision", Wanted::kHigh},
    {"average_precision", Wanted::kHigh},
    {"brier", Wanted::kLow},
    {"calibration_error", Wanted::kLow},
    {"mean_right", Wanted::kSame},
    {"mean_wrong", Wanted::kSame},
};

double numberOf(const json& value, const std::string& where, const std::string& key) {
  if (value.is_null()) return kNothing;
  if (value.is_number()) return value.get<double>();
  throw Error(fmt::format("{}: field \"{}\" must be a number, or null for nothing", where, key));
}

FiguresByKey figuresOf(const json& value, const std::string& where) {
  StrictObject object(value, where);
  FiguresByKey figures;
  for (const CheckedFigure& figure : kChecked) {
    figures[figure.key] = numberOf(object.any(figure.key), where, figure.key);
  }
  object.finish();
  return figures;
}

FiguresByKey slackOf(const json& value, const std::string& where) {
  StrictObject object(value, where);
  FiguresByKey slack;
  for (const CheckedFigure& figure : kChecked) {
    slack[figure.key] = object.number(figure.key, 0.0, 1.0, 0.0);
  }
  object.finish();
  return slack;
}

ExpectedRow expectedOf(const json& value, const std::string& where) {
  StrictObject object(value, where);
  ExpectedRow row{object.text("sensor"), object.text("kind"), {}};
  row.figures = figuresOf(object.any("figures"), where + " figures");
  object.finish();
  return row;
}

/// How far a figure went the wrong way; infinite where it came or went.
double wrongWay(Wanted wanted, double was, double now) {
  if (std::isnan(was) != std::isnan(now)) return std::numeric_limits<double>::infinity();
  if (wanted == Wanted::kHigh) return was - now;
  if (wanted == Wanted::kLow) return now - was;
  return std::abs(now - was);
}

/// A few parts make the figures of one kind jump: there only what lies in the bins decides.
bool decides(const GateRow& row, const CheckedFigure& figure) {
  const std::string key = figure.key;
  return row.kind == kAllKinds || key == "images" || key == "parts";
}

const ExpectedRow& expectedFor(const ShortGate& gate, const GateRow& row) {
  for (const ExpectedRow& expected : gate.expected) {
    if (expected.sensor == row.sensor && expected.kind == row.kind) return expected;
  }
  throw Error(fmt::format(
      "short gate: nothing is on record for {}, {}; record it by --record", row.sensor, row.kind));
}

double rounded(double value) { return std::round(value * 1e6) / 1e6; }

std::string plain(double value) {
  return std::isnan(value) ? "nothing" : fmt::format("{:.4g}", value);
}

}  // namespace

ShortGate readShortGate(const std::filesystem::path& path) {
  const std::string where = fileLabel("short gate", path);
  const json value = parseJsonObject(readFileBytes(path, "short gate", kMaxBytes), where);
  StrictObject object(value, where);
  ShortGate gate;
  gate.recipes = parseRecipes(object.any("recipes").dump(), where + " recipes");
  gate.slack = slackOf(object.any("slack"), where + " slack");
  for (const json& row : object.list("expected")) {
    gate.expected.push_back(
        expectedOf(row, fmt::format("{} expected {}", where, gate.expected.size() + 1)));
  }
  object.finish();
  if (gate.recipes.sets.size() != 1) throw Error(where + ": one set is expected");
  return gate;
}

std::vector<Movement> movements(const ShortGate& gate, const std::vector<GateRow>& rows) {
  std::vector<Movement> moved;
  std::size_t compared = 0;
  for (const GateRow& row : rows) {
    if (!row.part.empty()) continue;
    ++compared;
    const ExpectedRow& expected = expectedFor(gate, row);
    for (const CheckedFigure& figure : kChecked) {
      const double was = expected.figures.at(figure.key);
      const double now = gateColumn(figure.key).value(row.figures);
      const double slack = gate.slack.at(figure.key);
      const bool same = std::isnan(was) ? std::isnan(now) : std::abs(now - was) <= kSameNumber;
      if (same) continue;
      const bool fails =
          decides(row, figure) && wrongWay(figure.wanted, was, now) > slack + kSameNumber;
      moved.push_back({row.sensor, row.kind, figure.key, was, now, slack, fails});
    }
  }
  if (compared != gate.expected.size()) {
    throw Error(
        fmt::format("short gate: {} rows are on record, {} were measured; record them by "
                    "--record",
                    gate.expected.size(),
                    compared));
  }
  return moved;
}

std::string movementText(const std::vector<Movement>& movements) {
  std::string failed;
  std::string other;
  for (const Movement& one : movements) {
    (one.fails ? failed : other) += fmt::format("{} {}, {}: {} {} -> {} (slack {:g})\n",
                                                one.fails ? "FAILED" : "moved ",
                                                one.sensor,
                                                one.kind,
                                                one.figure,
                                                plain(one.was),
                                                plain(one.now),
                                                one.slack);
  }
  return other + failed;
}

std::string recorded(const std::filesystem::path& path, const std::vector<GateRow>& rows) {
  const std::string text = readFileBytes(path, "short gate", kMaxBytes);
  const std::size_t field = text.find("\"expected\"");
  std::string lines;
  for (const GateRow& row : rows) {
    if (!row.part.empty()) continue;
    Json figures = Json::object();
    for (const CheckedFigure& figure : kChecked) {
      const double value = gateColumn(figure.key).value(row.figures);
      figures[figure.key] = std::isnan(value) ? Json() : Json(rounded(value));
    }
    const Json line = {{"sensor", row.sensor}, {"kind", row.kind}, {"figures", figures}};
    lines += (lines.empty() ? "    " : ",\n    ") + line.dump();
  }
  const std::string expected = "\"expected\": [\n" + lines + "\n  ]\n}\n";
  std::string with_rows = text.substr(0, field) + expected;
  json all_else = parseJsonObject(text, "short gate");
  all_else["expected"] = json::parse(with_rows, nullptr, false).value("expected", json());
  if (all_else == json::parse(with_rows, nullptr, false)) return with_rows;
  throw Error(fileLabel("short gate", path) + ": field \"expected\" must be the last one");
}

}  // namespace rangepose::gate
