// Checked access to JSON: each error names the file and the field.
#pragma once

#include <cstddef>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "core/camera.h"

namespace rangepose {

/// Parses a text that must be one JSON object. `where` names its source in messages.
nlohmann::json parseJsonObject(std::string_view text, const std::string& where);

/// Reads and parses a file that must hold one JSON object (or, if `list`, one JSON array).
nlohmann::json readJsonFile(const std::filesystem::path& path,
                            std::string_view what,
                            bool list = false);

/// The finite number under `key`; Error when it is missing or something else.
double jsonNumber(const nlohmann::json& object, const char* key, const std::string& where);

/// The whole number under `key`, within [low, high].
int jsonInteger(
    const nlohmann::json& object, const char* key, int low, int high, const std::string& where);

/// `count` finite numbers in the array under `key`.
std::vector<double> jsonNumbers(const nlohmann::json& object,
                                const char* key,
                                std::size_t count,
                                const std::string& where);

/// A rotation from nine numbers, row by row; Error when it is not one within 1e-3.
glm::dmat3 rotationFromRows(const std::vector<double>& rows, const std::string& where_and_field);

/// The camera of a camera file or of an entry of BOP's scene_camera.json (see camera_file.h).
Camera cameraFromJson(const nlohmann::json& object, const std::string& where);

/// The bin of a bin file or of an entry of scene_bin.json (see camera_file.h).
BinBox binBoxFromJson(const nlohmann::json& object, const std::string& where);

}  // namespace rangepose
