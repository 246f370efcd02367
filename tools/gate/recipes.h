// The bins of the gate: which parts lie in them, and what sensors scan them (tools/gate/bins.json).
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace rangepose::gate {

struct SensorRecipe {
  std::string name;          ///< as `rangepose simulate --sensor` has it
  double distance_mm = 0.0;  ///< to the middle of the bin; 0: all of the bin is in the image
};

/// Parts by their path below the folder of models, without ".ply".
struct BinKind {
  std::string name;
  std::vector<std::string> parts;   ///< in the database, object ids 1, 2, ...
  std::vector<std::string> others;  ///< lie in the bins, too, but are not in the database
  bool mixed = false;               ///< all of them in each bin; else one a bin in turn
  bool none = false;                ///< only the others lie in the bins: each pose is wrong
  int count = 25;                   ///< parts in a bin
  int bins = 4;
  int emptying = 0;   ///< images of a bin, with fewer parts in each; 0: one image, of the full bin
  bool wear = false;  ///< parts differ a little from their CAD model
  std::uint64_t seed = 0;  ///< of the set, plus the number of kinds before this one
};

struct BinSet {
  std::string name;
  std::uint64_t seed = 0;
  std::string size;  ///< of the images [px], "640x480"; empty: that of the sensor
  std::vector<BinKind> kinds;

  /// All that lie in bins or databases of the set, each once, by name.
  std::vector<std::string> parts() const;
};

struct Recipes {
  std::vector<SensorRecipe> sensors;
  std::vector<BinSet> sets;

  /// Throws Error naming those that there are.
  const BinSet& set(const std::string& name) const;
  const SensorRecipe& sensor(const std::string& name) const;
};

/// The kinds of a set with these names, all where none is given; `bins` of each, 0: as the recipes
/// say. Throws Error, naming those that there are, for other names.
std::vector<BinKind> kindsOf(const BinSet& set, const std::vector<std::string>& names, int bins);
/// The sensors with these names, all where none is given. Throws Error for other names.
std::vector<SensorRecipe> sensorsOf(const Recipes& recipes, const std::vector<std::string>& names);

/// A set takes the seeds from its own on, this many; no two sets may share one.
inline constexpr std::uint64_t kSeedsOfSet = 100;

/// Reads a JSON object; `where` names it in messages. Throws Error, naming the field, for what is
/// unknown, missing or out of range, and for a part or seed that is in two sets: what was tuned on
/// one must not be reported on.
Recipes parseRecipes(std::string_view json, const std::string& where);
Recipes readRecipes(const std::filesystem::path& path);

}  // namespace rangepose::gate
