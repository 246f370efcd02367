// Whole frames: depth image in, pose out, with the database in memory.
#include <fstream>
#include <map>
#include <sstream>

#include "bench/fixture.h"
#include "bench/measure.h"

namespace rangepose::bench {
namespace {

/// From here on VmHWM counts anew from what is in memory now; where the kernel forbids it, it stays
/// the peak of the process.
void resetPeakMemory() { std::ofstream("/proc/self/clear_refs") << "5"; }

/// VmHWM [MB]; 0 where there is no /proc.
double peakMemoryMb() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.rfind("VmHWM:", 0) != 0) continue;
    std::istringstream words(line.substr(6));
    double kilobytes = 0.0;
    words >> kilobytes;
    return kilobytes * 1024.0 / 1.0e6;
  }
  return 0.0;
}

/// Mean times of the stages of a frame, of their sums over all iterations [ms].
void countStages(benchmark::State& state, const std::map<std::string, double>& sums_ms) {
  for (const auto& [stage, sum_ms] : sums_ms) {
    state.counters[stage + "_ms"] = benchmark::Counter(sum_ms, benchmark::Counter::kAvgIterations);
  }
}

void addFrame(Fixture& fixture,
              const Path& path,
              const std::string& image_name,
              const DepthImage& (Fixture::*image)(),
              int views) {
  const std::string name =
      "BM_Frame/" + path.name + "/" + image_name + "/views:" + std::to_string(views);
  add(name, [&fixture, path, image, views](benchmark::State& state) {
    const DepthImage& depth = (fixture.*image)();
    const ReferenceDatabase& database = fixture.database(views);
    EstimateOptions options;
    options.starts = kStarts;
    // The first frame packs or uploads the views.
    Estimate estimate = estimatePoses(depth, std::nullopt, database, options, *path.stages);
    resetPeakMemory();
    std::map<std::string, double> ms;
    for (auto _ : state) {
      estimate = estimatePoses(depth, std::nullopt, database, options, *path.stages);
      for (const StageTime& time : estimate.times) ms[time.stage] += time.ms;
    }
    countStages(state, ms);
    state.counters["peak_MB"] = peakMemoryMb();
    state.counters["score"] = estimate.poses.empty() ? 0.0 : estimate.poses.front().confidence;
  });
}

void addAllParts(Fixture& fixture, const Path& path, int views) {
  const std::string name = "BM_AllParts/" + path.name + "/640x480/views:" + std::to_string(views);
  add(name, [&fixture, path, views](benchmark::State& state) {
    const Fixture::Bin& bin = fixture.bin();
    const ReferenceDatabase& database = fixture.database(views);
    EstimateOptions options;
    options.max_poses = 100;
    Estimate estimate = estimatePoses(bin.image, bin.box, database, options, *path.stages);
    std::map<std::string, double> ms;
    for (auto _ : state) {
      estimate = estimatePoses(bin.image, bin.box, database, options, *path.stages);
      for (const StageTime& time : estimate.times) ms[time.stage] += time.ms;
    }
    countStages(state, ms);
    state.counters["poses"] = static_cast<double>(estimate.poses.size());
  });
}

}  // namespace

void registerFrameBenchmarks(Fixture& fixture) {
  for (const Path& path : fixture.paths()) {
    const int views = path.software ? 64 : 1024;
    addFrame(fixture, path, "640x480", &Fixture::demo, views);
    if (path.software) continue;
    addFrame(fixture, path, "848x480", &Fixture::heap, views);
    addAllParts(fixture, path, views);
  }
}

}  // namespace rangepose::bench
