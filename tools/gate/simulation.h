// The command line that makes the bins of a kind by a sensor.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "gate/recipes.h"

namespace rangepose::gate {

struct Simulation {
  std::vector<std::filesystem::path> models;  ///< that lie in the bins
  std::vector<std::string> options;           ///< of `rangepose simulate`, all that files depend on
};

/// `models` is the folder that the names of parts are paths below. Throws Error where a mesh is
/// missing.
Simulation simulationOf(const BinSet& set,
                        const BinKind& kind,
                        const SensorRecipe& sensor,
                        const std::filesystem::path& models);

/// A bin that takes a second, by the same sensor and with the same options: its files tell whether
/// a simulator is still the one that made the bins of the cache.
Simulation tinySimulation(const BinSet& set,
                          const BinKind& kind,
                          const SensorRecipe& sensor,
                          const std::filesystem::path& models);

/// The meshes of the parts in the database, in the order of their ids.
std::vector<std::filesystem::path> meshesOf(const std::vector<std::string>& parts,
                                            const std::filesystem::path& models);

}  // namespace rangepose::gate
