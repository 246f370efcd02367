// The scene that `estimate` and `compare` are given: files, camera, bin, and the database.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "core/camera.h"

namespace rangepose::cli {

struct SceneArguments {
  std::string database;
  std::string depth;
  std::string cloud;
  std::string camera;
  std::string bin;
  std::string unit;  ///< of the cloud; empty: metres

  bool given() const { return !depth.empty() || !cloud.empty(); }
  /// The image's file, for reports.
  const std::string& file() const { return depth.empty() ? cloud : depth; }
};

/// --db, --depth, --cloud, --camera, --bin, --unit.
void declareScene(CLI::App& command, SceneArguments& arguments);

/// Throws UsageError unless exactly one kind of scene is given, with what belongs to it.
void checkScene(const SceneArguments& arguments);

DepthImage readScene(const SceneArguments& arguments);
std::optional<BinBox> readBin(const SceneArguments& arguments);

/// Accepts finite numbers from 0 to 1.
CLI::Validator shareValidator();

}  // namespace rangepose::cli
