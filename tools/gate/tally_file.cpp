#include "gate/tally_file.h"

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "io/json_fields.h"

namespace rangepose::gate {
namespace {

using nlohmann::json;

json numberJson(double value) { return std::isnan(value) ? json() : json(value); }

double numberOf(const json& value) {
  return value.is_null() ? std::numeric_limits<double>::quiet_NaN() : value.get<double>();
}

json posesJson(const std::vector<JudgedPose>& poses) {
  json list = json::array();
  for (const JudgedPose& pose : poses) {
    list.push_back({pose.score, static_cast<int>(pose.verdict), numberJson(pose.error)});
  }
  return list;
}

std::vector<JudgedPose> posesOf(const json& list) {
  std::vector<JudgedPose> poses;
  for (const json& pose : list) {
    const int verdict = pose.at(1).get<int>();
    RP_CHECK(verdict >= 0 && verdict <= static_cast<int>(PoseVerdict::kFalse), "verdict");
    poses.push_back(
        {pose.at(0).get<double>(), static_cast<PoseVerdict>(verdict), numberOf(pose.at(2))});
  }
  return poses;
}

json tallyJson(const ImageTally& tally) {
  return {{"id", {tally.id.first, tally.id.second}},
          {"holds_none", tally.holds_none},
          {"parts", tally.parts},
          {"first_right", tally.first_right ? json(*tally.first_right) : json()},
          {"shown", posesJson(tally.shown)},
          {"found_as_seen", tally.found_as_seen},
          {"false_as_seen", tally.false_as_seen},
          {"checked", posesJson(tally.checked)},
          {"time_s", numberJson(tally.time_s)}};
}

ImageTally tallyFrom(const json& value) {
  ImageTally tally;
  tally.id = {value.at("id").at(0).get<int>(), value.at("id").at(1).get<int>()};
  tally.holds_none = value.at("holds_none").get<bool>();
  tally.parts = value.at("parts").get<int>();
  const json& first = value.at("first_right");
  if (!first.is_null()) tally.first_right = first.get<bool>();
  tally.shown = posesOf(value.at("shown"));
  tally.found_as_seen = value.at("found_as_seen").get<int>();
  tally.false_as_seen = value.at("false_as_seen").get<int>();
  tally.checked = posesOf(value.at("checked"));
  tally.time_s = numberOf(value.at("time_s"));
  return tally;
}

json imagesJson(const std::vector<ImageTally>& images) {
  json list = json::array();
  for (const ImageTally& tally : images) list.push_back(tallyJson(tally));
  return list;
}

std::vector<ImageTally> imagesFrom(const json& list) {
  std::vector<ImageTally> images;
  for (const json& tally : list) images.push_back(tallyFrom(tally));
  return images;
}

}  // namespace

std::string talliesText(const CellTallies& tallies) {
  json parts = json::array();
  for (const std::vector<ImageTally>& part : tallies.of_part) parts.push_back(imagesJson(part));
  const json file = {{"all", imagesJson(tallies.all)}, {"of_part", std::move(parts)}};
  return file.dump() + "\n";
}

CellTallies talliesFrom(std::string_view text, const std::string& where) {
  try {
    const json file = parseJsonObject(text, where);
    CellTallies tallies;
    tallies.all = imagesFrom(file.at("all"));
    for (const json& part : file.at("of_part")) tallies.of_part.push_back(imagesFrom(part));
    return tallies;
  } catch (const json::exception&) {
    throw Error(where + ": damaged; remove it");
  }
}

}  // namespace rangepose::gate
