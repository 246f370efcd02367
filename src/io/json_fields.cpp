#include "io/json_fields.h"

#include <fmt/format.h>

#include <cmath>

#include "core/error.h"
#include "core/pose.h"
#include "io/file_bytes.h"

namespace rangepose {
namespace {

using nlohmann::json;

constexpr std::uintmax_t kMaxJsonBytes = std::uintmax_t{256} << 20;

[[noreturn]] void failField(const std::string& where, const char* key, const std::string& problem) {
  throw Error(fmt::format("{}: field \"{}\" {}", where, key, problem));
}

const json& requiredField(const json& object, const char* key, const std::string& where) {
  const auto found = object.find(key);
  if (found == object.end()) failField(where, key, "is missing; add it");
  return *found;
}

json parsed(std::string_view text, const std::string& where) {
  try {
    return json::parse(text);
  } catch (const json::exception& failure) {
    throw Error(fmt::format("{}: not valid JSON ({})", where, oneLine(failure.what())));
  }
}

}  // namespace

json parseJsonObject(std::string_view text, const std::string& where) {
  json value = parsed(text, where);
  if (!value.is_object()) throw Error(where + ": a JSON object {...} is expected");
  return value;
}

json readJsonFile(const std::filesystem::path& path, std::string_view what, bool list) {
  const std::string text = readFileBytes(path, what, kMaxJsonBytes);
  const std::string where = fileLabel(what, path);
  if (!list) return parseJsonObject(text, where);
  json value = parsed(text, where);
  if (!value.is_array()) throw Error(where + ": a JSON array [...] is expected");
  return value;
}

double jsonNumber(const json& object, const char* key, const std::string& where) {
  const json& value = requiredField(object, key, where);
  if (!value.is_number()) failField(where, key, "must be a number");
  const double number = value.get<double>();
  if (!std::isfinite(number)) failField(where, key, "must be finite");
  return number;
}

int jsonInteger(const json& object, const char* key, int low, int high, const std::string& where) {
  const double number = jsonNumber(object, key, where);
  if (number != std::floor(number) || number < low || number > high) {
    failField(where, key, fmt::format("must be a whole number from {} to {}", low, high));
  }
  return static_cast<int>(number);
}

std::vector<double> jsonNumbers(const json& object,
                                const char* key,
                                std::size_t count,
                                const std::string& where) {
  const json& value = requiredField(object, key, where);
  if (!value.is_array() || value.size() != count) {
    failField(where, key, fmt::format("must be an array of {} numbers", count));
  }
  std::vector<double> numbers;
  numbers.reserve(count);
  for (const json& entry : value) {
    if (!entry.is_number() || !std::isfinite(entry.get<double>())) {
      failField(where, key, fmt::format("entry {} must be a finite number", numbers.size()));
    }
    numbers.push_back(entry.get<double>());
  }
  return numbers;
}

glm::dmat3 rotationFromRows(const std::vector<double>& rows, const std::string& where_and_field) {
  constexpr double kTolerance = 1e-3;  // room for files written with four decimals
  glm::dmat3 rotation{1.0};
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      rotation[column][row] =
          rows.at(static_cast<std::size_t>(row) * 3 + static_cast<std::size_t>(column));
    }
  }
  const glm::dmat3 product = glm::transpose(rotation) * rotation;
  double worst = std::abs(glm::determinant(rotation) - 1.0);
  for (int column = 0; column < 3; ++column) {
    for (int row = 0; row < 3; ++row) {
      worst = std::max(worst, std::abs(product[column][row] - (row == column ? 1.0 : 0.0)));
    }
  }
  if (!(worst <= kTolerance)) {
    throw Error(where_and_field + " is not a rotation matrix (orthonormal, determinant +1)");
  }
  return orthonormalized(rotation);
}

}  // namespace rangepose
