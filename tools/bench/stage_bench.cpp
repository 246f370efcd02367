// The image stages: depth image to channels, patches and windows.
#include "bench/fixture.h"
#include "bench/measure.h"
#include "pipeline/foreground_task.h"

namespace rangepose::bench {
namespace {

constexpr int kViews = 256;  // the windows do not depend on it

const ObjectTrace& demoTrace(Fixture& fixture) { return fixture.trace(kViews).objects.front(); }

double pixelsOf(const OrthoCamera& camera) {
  return static_cast<double>(camera.width) * camera.height;
}

void addForeground(Fixture& fixture, const Path& path) {
  add("BM_Foreground/" + path.name + "/640x480", [&fixture, path](benchmark::State& state) {
    const DepthImage& depth = fixture.demo();
    const ForegroundTask task = foregroundTaskFor(fixture.database(kViews), std::nullopt);
    for (auto _ : state) benchmark::DoNotOptimize(path.stages->foreground->find(depth, task));
    rate(state, "pixels", static_cast<double>(depth.depth_mm.size()));
  });
}

/// `stage(stages, trace)` on the whole scene image.
template <typename Stage>
void addSceneStage(Fixture& fixture, const Path& path, const std::string& name, Stage stage) {
  add("BM_" + name + "/" + path.name, [&fixture, path, stage](benchmark::State& state) {
    const ObjectTrace& trace = demoTrace(fixture);
    for (auto _ : state) benchmark::DoNotOptimize(stage(*path.stages, trace));
    rate(state, "pixels", pixelsOf(trace.scene.camera));
  });
}

void addWindows(Fixture& fixture, const Path& path) {
  add("BM_Windows/" + path.name + "/starts:" + std::to_string(kStarts),
      [&fixture, path](benchmark::State& state) {
        const ObjectTrace& trace = demoTrace(fixture);
        const ChannelOptions options = channelOptionsOf(fixture.database(kViews).objects.front());
        double pixels = 0.0;
        for (const SceneChannels& window : trace.windows) pixels += pixelsOf(window.camera);
        std::vector<WindowTask> tasks;
        for (std::size_t i = 0; i < trace.windows.size(); ++i)
          tasks.push_back({trace.windows[i].camera, trace.window_regions[i]});
        for (auto _ : state) {
          const std::unique_ptr<ResidentDepth> depth =
              path.stages->foreground->upload(fixture.demo(), fixture.trace(kViews).foreground);
          // Downloaded, so that a device has finished.
          for (const auto& window : path.stages->scenes->prepare(*depth, tasks, options))
            benchmark::DoNotOptimize(window->download());
        }
        rate(state, "pixels", pixels);
      });
}

}  // namespace

void registerStageBenchmarks(Fixture& fixture) {
  for (const Path& path : fixture.paths()) {
    addForeground(fixture, path);
    addSceneStage(
        fixture, path, "Resample", [&fixture](StageSet& stages, const ObjectTrace& trace) {
          return stages.probe->resample(
              fixture.demo(), fixture.trace(kViews).foreground, trace.scene.camera);
        });
    addSceneStage(fixture, path, "Median", [](StageSet& stages, const ObjectTrace& trace) {
      return stages.probe->median(trace.raw_range_px);
    });
    addSceneStage(fixture, path, "Edges", [](StageSet& stages, const ObjectTrace& trace) {
      return stages.probe->edges(trace.scene.range_px, trace.scene_options.edgeThresholdPx());
    });
    addSceneStage(fixture, path, "Edt", [](StageSet& stages, const ObjectTrace& trace) {
      return stages.probe->distance(
          trace.scene.range_px, trace.scene.edges, trace.scene_options.edt_passes);
    });
    addSceneStage(fixture, path, "Patches", [](StageSet& stages, const ObjectTrace& trace) {
      return stages.probe->patches(trace.scene.range_px, trace.scene.edges);
    });
    addWindows(fixture, path);
  }
}

}  // namespace rangepose::bench
