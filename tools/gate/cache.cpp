#include "gate/cache.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include "core/error.h"
#include "gate/content_hash.h"
#include "gate/process.h"
#include "io/atomic_file.h"
#include "io/file_bytes.h"

namespace rangepose::gate {
namespace {

namespace fs = std::filesystem;

fs::path partial(const fs::path& path) { return path.string() + ".part"; }

void moveTo(const fs::path& from, const fs::path& to) {
  std::error_code failure;
  fs::rename(from, to, failure);
  if (failure) throw Error(fmt::format("{}: cannot be made ({})", to.string(), failure.message()));
}

void addFiles(std::vector<std::string>& words, const std::vector<fs::path>& more) {
  for (const fs::path& path : more) words.push_back(path.string());
}

void add(std::vector<std::string>& words, const std::vector<std::string>& more) {
  words.insert(words.end(), more.begin(), more.end());
}

}  // namespace

Cache::Cache(const fs::path& folder, int threads) : folder_(folder), threads_(threads) {
  const std::string label = "cache " + folder.string();
  for (const char* name : {"bins", "databases", "answers", "grades", "fingerprints", "logs"}) {
    std::error_code failure;
    fs::create_directories(folder / name, failure);
    if (failure) throw Error(fmt::format("{}: cannot be made ({})", label, failure.message()));
  }
  // Kept by children: a bin that is still in work when the gate is gone keeps others off.
  lock_ = open((folder / "lock").c_str(), O_RDWR | O_CREAT, 0644);
  if (lock_ < 0) throw Error(label + ": is not writable; choose another one by --cache");
  if (flock(lock_, LOCK_EX | LOCK_NB) == 0) return;
  close(lock_);
  throw Error(label + ": another run uses it; wait, or choose another one by --cache");
}

Cache::~Cache() { close(lock_); }

const std::string& Cache::hashOf(const fs::path& file) {
  const auto found = hashes_.find(file);
  if (found != hashes_.end()) return found->second;
  return hashes_[file] = ContentHash().addFile(file).text();
}

fs::path Cache::grades(const std::string& key) const {
  return folder_ / "grades" / (key + ".json");
}

std::string Cache::keyOf(const Simulation& simulation) {
  ContentHash hash;
  for (const fs::path& model : simulation.models)
    hash.add(model.stem().string()).add(hashOf(model));
  for (const std::string& option : simulation.options) hash.add(option);
  return hash.text();
}

void Cache::simulate(const fs::path& simulator,
                     const Simulation& simulation,
                     const fs::path& folder,
                     const fs::path& log) const {
  fs::remove_all(partial(folder));
  std::vector<std::string> words = {simulator.string(), "simulate"};
  addFiles(words, simulation.models);
  add(words, {"--out", partial(folder).string(), "--threads", std::to_string(threads_)});
  add(words, simulation.options);
  runLogged(words, log);
}

std::string Cache::fingerprint(const fs::path& simulator, const Simulation& tiny) {
  const std::string key = ContentHash().add(hashOf(simulator)).add(keyOf(tiny)).text();
  const fs::path file = folder_ / "fingerprints" / key;
  if (!fs::exists(file)) {
    simulate(simulator, tiny, file, folder_ / "logs" / ("tiny-" + key + ".txt"));
    const std::string hash = ContentHash().addFolder(partial(file)).text();
    fs::remove_all(partial(file));
    writeFileAtomically(file, hash);
  }
  return readFileBytes(file, "fingerprint", 1 << 10);
}

fs::path Cache::dataSet(const fs::path& simulator,
                        const Simulation& simulation,
                        const Simulation& tiny) {
  const std::string key =
      ContentHash().add(fingerprint(simulator, tiny)).add(keyOf(simulation)).text();
  fs::path folder = folder_ / "bins" / key;
  if (fs::exists(folder)) return folder;
  simulate(simulator, simulation, folder, folder_ / "logs" / ("bins-" + key + ".txt"));
  moveTo(partial(folder), folder);
  return folder;
}

fs::path Cache::database(const fs::path& program, const std::vector<fs::path>& meshes) {
  ContentHash hash;
  hash.add(hashOf(program));
  for (const fs::path& mesh : meshes) hash.add(mesh.stem().string()).add(hashOf(mesh));
  const std::string key = hash.text();
  fs::path file = folder_ / "databases" / (key + ".rpdb");
  if (fs::exists(file)) return file;
  std::vector<std::string> words = {program.string(), "build"};
  addFiles(words, meshes);
  add(words, {"--out", file.string(), "--path", "host", "--threads", std::to_string(threads_)});
  runLogged(words, folder_ / "logs" / ("database-" + key + ".txt"));
  return file;
}

fs::path Cache::answers(const fs::path& program,
                        const std::vector<std::string>& options,
                        const fs::path& database,
                        const fs::path& data_set) {
  ContentHash hash;
  hash.add(hashOf(program)).add(hashOf(database)).add(data_set.filename().string());
  for (const std::string& option : options) hash.add(option);
  const std::string key = hash.add(std::to_string(threads_)).text();
  fs::path file = folder_ / "answers" / (key + ".csv");
  if (fs::exists(file)) return file;
  // Under another name until the program has said that all went well.
  const fs::path unsure = partial(file);
  fs::remove(unsure);
  fs::remove(unsure.string() + ".partial");  // of a run that was interrupted
  std::vector<std::string> words = {program.string()};
  add(words, options);
  add(words, {"--db", database.string(), "--bop", data_set.string(), "--csv", unsure.string()});
  add(words, {"--threads", std::to_string(threads_)});
  runLogged(words, folder_ / "logs" / ("answers-" + key + ".txt"));
  moveTo(unsure, file);
  return file;
}

}  // namespace rangepose::gate
