#include "gate/strict_json.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "core/error.h"
#include "io/file_bytes.h"

namespace rangepose::gate {

using nlohmann::json;

StrictObject::StrictObject(const json& object, std::string where)
    : json_(object), where_(std::move(where)) {
  if (!json_.is_object()) throw Error(where_ + ": a JSON object {...} is expected");
}

void StrictObject::fail(const char* key, const std::string& problem) const {
  throw Error(fmt::format("{}: field \"{}\" {}", where_, key, problem));
}

const json* StrictObject::find(const char* key) {
  known_.insert(key);
  const auto found = json_.find(key);
  return found == json_.end() ? nullptr : &*found;
}

const json& StrictObject::any(const char* key) {
  const json* value = find(key);
  if (value == nullptr) fail(key, "is missing; add it");
  return *value;
}

std::string StrictObject::text(const char* key) {
  const json& value = any(key);
  if (!value.is_string() || value.get<std::string>().empty()) fail(key, "must be a text");
  return value.get<std::string>();
}

std::string StrictObject::text(const char* key, const std::string& fallback) {
  return find(key) == nullptr ? fallback : text(key);
}

bool StrictObject::flag(const char* key, bool fallback) {
  const json* value = find(key);
  if (value == nullptr) return fallback;
  if (!value->is_boolean()) fail(key, "must be true or false");
  return value->get<bool>();
}

double StrictObject::number(const char* key, double low, double high) {
  const json& value = any(key);
  const double number = value.is_number() ? value.get<double>() : std::nan("");
  if (!(number >= low && number <= high)) {
    fail(key, fmt::format("must be a number from {:g} to {:g}", low, high));
  }
  return number;
}

double StrictObject::number(const char* key, double low, double high, double fallback) {
  return find(key) == nullptr ? fallback : number(key, low, high);
}

int StrictObject::integer(const char* key, int low, int high) {
  const json& value = any(key);
  const double number = value.is_number() ? value.get<double>() : std::nan("");
  if (!(number >= low && number <= high) || number != std::floor(number)) {
    fail(key, fmt::format("must be a whole number from {} to {}", low, high));
  }
  return static_cast<int>(number);
}

int StrictObject::integer(const char* key, int low, int high, int fallback) {
  return find(key) == nullptr ? fallback : integer(key, low, high);
}

const json& StrictObject::list(const char* key) {
  const json& value = any(key);
  if (!value.is_array()) fail(key, "must be a list [...]");
  return value;
}

std::vector<std::string> StrictObject::texts(const char* key) {
  std::vector<std::string> texts;
  if (find(key) == nullptr) return texts;
  for (const json& value : list(key)) {
    if (!value.is_string()) fail(key, "must be a list of texts");
    texts.push_back(value.get<std::string>());
  }
  return texts;
}

void StrictObject::finish() const {
  for (const auto& [key, value] : json_.items()) {
    if (known_.count(key) > 0) continue;
    std::string names;
    for (const std::string& name : known_) names += (names.empty() ? "" : ", ") + name;
    throw Error(
        fmt::format("{}: field \"{}\" is unknown; there are {}", where_, oneLine(key), names));
  }
}

}  // namespace rangepose::gate
