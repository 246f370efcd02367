// What the gate makes once and keeps: data sets, databases, answers. Each is named by the contents
// that it depends on and written under another name until it is whole.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "gate/simulation.h"

namespace rangepose::gate {

class Cache {
 public:
  /// Makes the folder; throws Error where another run uses it.
  Cache(const std::filesystem::path& folder, int threads);
  Cache(const Cache&) = delete;
  Cache& operator=(const Cache&) = delete;
  ~Cache();

  /// The data set, made by `simulator` where it is not there. `tiny` is made first, to see whether
  /// the simulator is the one that made what is there.
  std::filesystem::path dataSet(const std::filesystem::path& simulator,
                                const Simulation& simulation,
                                const Simulation& tiny);

  /// The database of the meshes, with ids 1, 2, ...
  std::filesystem::path database(const std::filesystem::path& program,
                                 const std::vector<std::filesystem::path>& meshes);

  /// The result file of `program` with `options`, to which data set, database, result file and
  /// threads are added. Times in it are those of the first run.
  std::filesystem::path answers(const std::filesystem::path& program,
                                const std::vector<std::string>& options,
                                const std::filesystem::path& database,
                                const std::filesystem::path& data_set);

  /// The file for the grades of this key, there or not.
  std::filesystem::path grades(const std::string& key) const;

  /// Of the bytes of a file; read once.
  const std::string& hashOf(const std::filesystem::path& file);

 private:
  std::string fingerprint(const std::filesystem::path& simulator, const Simulation& tiny);
  void simulate(const std::filesystem::path& simulator,
                const Simulation& simulation,
                const std::filesystem::path& folder,
                const std::filesystem::path& log) const;
  std::string keyOf(const Simulation& simulation);

  std::filesystem::path folder_;
  int threads_ = 0;
  int lock_ = -1;
  std::map<std::filesystem::path, std::string> hashes_;
};

}  // namespace rangepose::gate
