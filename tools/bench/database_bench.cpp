// Building the reference database, and reading it from its file.
#include <unistd.h>

#include <filesystem>
#include <string_view>

#include "bench/fixture.h"
#include "bench/measure.h"
#include "geometry/orientation_grid.h"
#include "gles/references_gles.h"
#include "io/atomic_file.h"
#include "stages/reference_host.h"

namespace rangepose::bench {
namespace {

constexpr int kViews = 1024;

void addBuild(Fixture& fixture, gles::Context* context) {
  const std::string path = context != nullptr ? "glsl" : "host";
  add("BM_BuildDatabase/" + path + "/views:" + std::to_string(kViews),
      [&fixture, context](benchmark::State& state) {
        const ChannelOptions options = channelOptionsFor(kSizePx);
        const std::vector<glm::dmat3> rotations = uniformRotations(kViews);
        for (auto _ : state) {
          ReferenceObject object = describeObject(fixture.mesh(), 1, kSizePx, rotations, options);
          if (context != nullptr) {
            gles::renderReferences(*context, object, options);
          } else {
            host::renderReferences(object, options, {});
          }
          benchmark::DoNotOptimize(object.atlas.data());
        }
        rate(state, "views", kViews);
      });
}

/// A file in the temporary folder, removed at the end.
class DatabaseFile {
 public:
  explicit DatabaseFile(const std::vector<char>& bytes)
      : path_(std::filesystem::temp_directory_path() /
              ("rangepose_bench_" + std::to_string(getpid()) + ".rpdb")) {
    writeFileAtomically(path_, std::string_view(bytes.data(), bytes.size()));
  }
  DatabaseFile(const DatabaseFile&) = delete;
  DatabaseFile& operator=(const DatabaseFile&) = delete;
  ~DatabaseFile() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

void addLoad(Fixture& fixture) {
  add("BM_LoadDatabase/views:" + std::to_string(kViews), [&fixture](benchmark::State& state) {
    const std::vector<char> bytes = serialize(fixture.database(kViews));
    const DatabaseFile file(bytes);
    for (auto _ : state) benchmark::DoNotOptimize(readDatabase(file.path()));
    state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(bytes.size()));
    state.counters["file_MB"] = static_cast<double>(bytes.size()) / 1.0e6;
  });
}

}  // namespace

void registerDatabaseBenchmarks(Fixture& fixture) {
  if (fixture.context() != nullptr) addBuild(fixture, fixture.context());
  addBuild(fixture, nullptr);
  addLoad(fixture);
}

}  // namespace rangepose::bench
