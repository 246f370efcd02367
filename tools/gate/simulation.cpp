#include "gate/simulation.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"

namespace rangepose::gate {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> optionsOf(const BinSet& set,
                                   const BinKind& kind,
                                   const SensorRecipe& sensor) {
  std::vector<std::string> options;
  const auto add = [&options](const std::string& name, const std::string& value) {
    options.push_back(name);
    options.push_back(value);
  };
  add("--sensor", sensor.name);
  add("--count", std::to_string(kind.count));
  add("--bins", std::to_string(kind.bins));
  add("--seed", std::to_string(kind.seed));
  if (!set.size.empty()) add("--size", set.size);
  if (sensor.distance_mm > 0.0) add("--camera-distance", fmt::format("{:g}", sensor.distance_mm));
  if (kind.emptying > 0) add("--emptying", std::to_string(kind.emptying));
  if (kind.mixed) options.emplace_back("--mixed");
  if (kind.wear) options.emplace_back("--wear");
  return options;
}

}  // namespace

std::vector<fs::path> meshesOf(const std::vector<std::string>& parts, const fs::path& models) {
  std::vector<fs::path> meshes;
  for (const std::string& part : parts) {
    meshes.push_back(models / (part + ".ply"));
    std::error_code failure;
    if (fs::is_regular_file(meshes.back(), failure)) continue;
    throw Error(
        fmt::format("part {}: there is no {}; run this in the folder of the sources or name "
                    "the folder of models by --models",
                    part,
                    meshes.back().string()));
  }
  return meshes;
}

Simulation simulationOf(const BinSet& set,
                        const BinKind& kind,
                        const SensorRecipe& sensor,
                        const fs::path& models) {
  // Parts of the database come first, so that object ids of truth and database agree.
  std::vector<std::string> parts = kind.none ? std::vector<std::string>() : kind.parts;
  parts.insert(parts.end(), kind.others.begin(), kind.others.end());
  return {meshesOf(parts, models), optionsOf(set, kind, sensor)};
}

Simulation tinySimulation(const BinSet& set,
                          const BinKind& kind,
                          const SensorRecipe& sensor,
                          const fs::path& models) {
  BinSet tiny_set = set;
  tiny_set.size.clear();
  BinKind tiny = kind;
  tiny.seed = set.seed;
  tiny.bins = 1;
  tiny.count = 3;
  tiny.mixed = false;
  tiny.emptying = std::min(kind.emptying, 2);
  return {meshesOf({set.kinds.at(0).parts.at(0)}, models), optionsOf(tiny_set, tiny, sensor)};
}

}  // namespace rangepose::gate
