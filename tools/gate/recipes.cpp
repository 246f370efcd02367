#include "gate/recipes.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "core/error.h"
#include "gate/strict_json.h"
#include "io/file_bytes.h"
#include "io/json_fields.h"

namespace rangepose::gate {
namespace {

using nlohmann::json;

constexpr const char* kPartLetters = "abcdefghijklmnopqrstuvwxyz0123456789_/";

void checkParts(const std::vector<std::string>& parts, const std::string& where) {
  std::set<std::string> seen;
  for (const std::string& part : parts) {
    if (part.empty() || part.find_first_not_of(kPartLetters) != std::string::npos ||
        part.front() == '/' || part.find("//") != std::string::npos) {
      throw Error(fmt::format("{}: part \"{}\" is no path below the folder of models without .ply",
                              where,
                              oneLine(part)));
    }
    if (!seen.insert(part).second) {
      throw Error(fmt::format("{}: part \"{}\" is named twice", where, part));
    }
  }
}

BinKind kindOf(const json& value, const std::string& where) {
  StrictObject object(value, where);
  BinKind kind;
  kind.name = object.text("name");
  kind.parts = object.texts("parts");
  kind.others = object.texts("others");
  kind.mixed = object.flag("mixed", kind.mixed);
  kind.none = object.flag("none", kind.none);
  kind.count = object.integer("count", 1, 500, kind.count);
  kind.bins = object.integer("bins", 1, 1000, kind.bins);
  kind.emptying = object.integer("emptying", 0, 500, kind.emptying);
  kind.wear = object.flag("wear", kind.wear);
  object.finish();
  std::vector<std::string> all = kind.parts;
  all.insert(all.end(), kind.others.begin(), kind.others.end());
  checkParts(all, where);
  if (kind.parts.empty()) throw Error(where + ": field \"parts\" names no part for the database");
  if (kind.none && kind.others.empty()) {
    throw Error(where + ": field \"none\" needs \"others\": what lies in the bins");
  }
  return kind;
}

template <typename Named>
void checkNames(const std::vector<Named>& all, const std::string& where) {
  std::set<std::string> seen;
  for (const Named& one : all) {
    if (seen.insert(one.name).second) continue;
    throw Error(fmt::format("{}: the name \"{}\" is there twice", where, oneLine(one.name)));
  }
}

BinSet setOf(const json& value, const std::string& where) {
  StrictObject object(value, where);
  BinSet set;
  set.name = object.text("name");
  set.seed = static_cast<std::uint64_t>(object.integer("seed", 0, 1 << 30));
  set.size = object.text("size", "");
  const json& kinds = object.list("kinds");
  object.finish();
  for (const json& kind : kinds) {
    set.kinds.push_back(kindOf(kind, fmt::format("{} kind {}", where, set.kinds.size() + 1)));
    set.kinds.back().seed = set.seed + set.kinds.size() - 1;
  }
  if (set.kinds.empty() || set.kinds.size() > kSeedsOfSet) {
    throw Error(fmt::format("{}: field \"kinds\" must have 1 to {} entries", where, kSeedsOfSet));
  }
  checkNames(set.kinds, where);
  return set;
}

SensorRecipe sensorOf(const json& value, const std::string& where) {
  StrictObject object(value, where);
  SensorRecipe sensor;
  sensor.name = object.text("name");
  sensor.distance_mm = object.number("distance_mm", 0.0, 1e5, 0.0);
  object.finish();
  return sensor;
}

void checkApart(const std::vector<BinSet>& sets, const std::string& where) {
  std::map<std::string, std::string> set_of_part;
  for (const BinSet& set : sets) {
    for (const std::string& part : set.parts()) {
      const auto [found, fresh] = set_of_part.try_emplace(part, set.name);
      if (fresh) continue;
      throw Error(fmt::format("{}: part \"{}\" is in the sets {} and {}; it may be in one only",
                              where,
                              part,
                              found->second,
                              set.name));
    }
  }
  for (std::size_t i = 0; i < sets.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      const auto [low, high] = std::minmax(sets[i].seed, sets[k].seed);
      if (high - low >= kSeedsOfSet) continue;
      throw Error(fmt::format("{}: the seeds of the sets {} and {} are less than {} apart",
                              where,
                              sets[k].name,
                              sets[i].name,
                              kSeedsOfSet));
    }
  }
}

template <typename Named>
const Named& named(const std::vector<Named>& all, const std::string& name, const char* what) {
  std::string names;
  for (const Named& one : all) {
    if (one.name == name) return one;
    names += (names.empty() ? "" : ", ") + one.name;
  }
  throw Error(fmt::format("there is no {} \"{}\"; there are {}", what, oneLine(name), names));
}

}  // namespace

std::vector<std::string> BinSet::parts() const {
  std::set<std::string> names;
  for (const BinKind& kind : kinds) {
    names.insert(kind.parts.begin(), kind.parts.end());
    names.insert(kind.others.begin(), kind.others.end());
  }
  return {names.begin(), names.end()};
}

const BinSet& Recipes::set(const std::string& name) const { return named(sets, name, "set"); }

const SensorRecipe& Recipes::sensor(const std::string& name) const {
  return named(sensors, name, "sensor");
}

std::vector<BinKind> kindsOf(const BinSet& set, const std::vector<std::string>& names, int bins) {
  std::vector<BinKind> kinds;
  std::string known;
  for (const BinKind& kind : set.kinds) {
    known += (known.empty() ? "" : ", ") + kind.name;
    if (names.empty() || std::find(names.begin(), names.end(), kind.name) != names.end()) {
      kinds.push_back(kind);
      if (bins > 0) kinds.back().bins = bins;
    }
  }
  if (kinds.size() < names.size()) {
    throw Error(fmt::format("set {}: a --kind is not in it; there are {}", set.name, known));
  }
  return kinds;
}

std::vector<SensorRecipe> sensorsOf(const Recipes& recipes, const std::vector<std::string>& names) {
  std::vector<SensorRecipe> sensors;
  for (const std::string& name : names) sensors.push_back(recipes.sensor(name));
  return sensors.empty() ? recipes.sensors : sensors;
}

Recipes parseRecipes(std::string_view text, const std::string& where) {
  const json value = parseJsonObject(text, where);
  StrictObject object(value, where);
  Recipes recipes;
  for (const json& sensor : object.list("sensors")) {
    recipes.sensors.push_back(
        sensorOf(sensor, fmt::format("{} sensor {}", where, recipes.sensors.size() + 1)));
  }
  for (const json& set : object.list("sets")) {
    recipes.sets.push_back(setOf(set, fmt::format("{} set {}", where, recipes.sets.size() + 1)));
  }
  object.finish();
  checkNames(recipes.sensors, where + " sensors");
  checkNames(recipes.sets, where + " sets");
  checkApart(recipes.sets, where);
  return recipes;
}

Recipes readRecipes(const std::filesystem::path& path) {
  constexpr std::uintmax_t kMaxBytes = 1 << 20;
  return parseRecipes(readFileBytes(path, "bins", kMaxBytes), fileLabel("bins", path));
}

}  // namespace rangepose::gate
