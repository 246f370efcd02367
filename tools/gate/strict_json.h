// A JSON object that must be read whole: what nobody asked for is an error.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

namespace rangepose::gate {

/// Each getter throws Error, naming the field, for a value of another kind. `fallback`: what a
/// missing field stands for.
class StrictObject {
 public:
  /// `json` must outlive it and `where` name it in messages. Throws Error for other than an object.
  StrictObject(const nlohmann::json& json, std::string where);

  const std::string& where() const { return where_; }
  std::string text(const char* key);
  std::string text(const char* key, const std::string& fallback);
  bool flag(const char* key, bool fallback);
  int integer(const char* key, int low, int high);
  int integer(const char* key, int low, int high, int fallback);
  double number(const char* key, double low, double high);
  double number(const char* key, double low, double high, double fallback);
  std::vector<std::string> texts(const char* key);  ///< missing: none
  const nlohmann::json& list(const char* key);
  const nlohmann::json& any(const char* key);

  /// Throws Error for fields that no getter was asked for.
  void finish() const;

 private:
  const nlohmann::json* find(const char* key);
  [[noreturn]] void fail(const char* key, const std::string& problem) const;
  const nlohmann::json& json_;
  std::string where_;
  std::set<std::string> known_;
};

}  // namespace rangepose::gate
