#include "device_bench/rows.h"
#include "pipeline/foreground_task.h"

namespace rangepose::device_bench {
namespace {

class StageRows {
 public:
  StageRows(const Workload& load, const BenchPath& path, int runs)
      : load_(load), path_(path), runs_(runs), host_(makeHostStages()) {}

  std::vector<Row> all() {
    images();
    scene();
    if (!path_.slow) search();
    refinement();
    if (!path_.slow) frame();
    return std::move(rows_);
  }

 private:
  template <typename Stage>
  void add(const std::string& what, const Work& work, const Stage& stage) {
    Row row = timed(what, path_.name, runs_, [&] { return wallMs(stage); });
    row.work = work;
    row.on_gpu = path_.on_gpu;
    rows_.push_back(row);
  }

  /// Bytes: what must be read and written once. Operations: compares and adds of one pixel.
  void images() {
    const ObjectTrace& trace = load_.first();
    const Image<float>& range = trace.scene.range_px;
    const Image<float>& edges = trace.scene.edges;
    const int passes = trace.scene_options.edt_passes;
    StageSet& stages = *path_.stages;
    // Three digits of the noise, lost pixels, mask; planes are tried on samples.
    const ForegroundTask task = foregroundTaskFor(load_.database, std::nullopt);
    add("foreground", imageWork(load_.depth.depth_mm, 29.0, 30.0), [&] {
      stages.foreground->find(load_.depth, task);
    });
    add("resample", imageWork(load_.depth.depth_mm, 4.0, 40.0), [&] {
      stages.probe->resample(load_.depth, load_.trace.foreground, trace.scene.camera);
    });
    add("median", imageWork(range, 8.0, 38.0), [&] { stages.probe->median(trace.raw_range_px); });
    add("edges", imageWork(range, 8.0, 24.0), [&] {
      stages.probe->edges(range, trace.scene_options.edgeThresholdPx());
    });
    add("distance", imageWork(range, 12.0, 8.0 * 7.0 * passes), [&] {
      stages.probe->distance(range, edges, passes);
    });
    add("patches", imageWork(range, 12.0, 0.0), [&] { stages.probe->patches(range, edges); });
  }

  void scene() {
    const ChannelOptions options = channelOptionsOf(load_.object());
    StageSet& stages = *path_.stages;
    const ObjectTrace& trace = load_.first();
    add("depth image to device", imageWork(load_.depth.depth_mm, 9.0, 0.0), [&] {
      stages.foreground->upload(load_.depth, load_.trace.foreground);
      if (path_.wait != nullptr) path_.wait();
    });
    const auto depth = stages.foreground->upload(load_.depth, load_.trace.foreground);
    std::vector<WindowTask> tasks;
    for (std::size_t i = 0; i < trace.windows.size(); ++i)
      tasks.push_back({trace.windows[i].camera, trace.window_regions[i]});
    add("windows of all starts", {}, [&] {
      // Downloaded, so that a device has finished.
      for (const auto& window : stages.scenes->prepare(*depth, tasks, options)) window->download();
    });
  }

  void search() {
    std::vector<std::unique_ptr<ResidentScene>> scenes;
    std::vector<const ResidentScene*> windows;
    for (const SceneChannels& window : load_.first().windows) {
      scenes.push_back(path_.stages->scenes->upload(window));
      windows.push_back(scenes.back().get());
    }
    add("rough search", searchWork(load_, *host_), [&] {
      path_.stages->search->search(
          load_.object(), windows, load_.first().seed_range_px, load_.first().search);
    });
  }

  void refinement() {
    StageSet& stages = *path_.stages;
    const auto depth = stages.foreground->upload(load_.depth, load_.trace.foreground);
    add("alignment of hypotheses", alignWork(load_), [&] {
      stages.refine->align(*depth, load_.alignments);
    });
    add("verdict on hypotheses", {}, [&] { stages.refine->judge(*depth, load_.verdicts); });
    add("rendering and alignment", {}, [&] {
      stages.refine->alignSurfaces(*depth, load_.surfaces);
    });
    add("rendering and verdict", {}, [&] { stages.refine->judgeSurfaces(*depth, load_.surfaces); });
  }

  void frame() {
    add("whole frame, first pose", {}, [&] {
      estimatePoses(load_.depth, std::nullopt, load_.database, load_.options, *path_.stages);
    });
  }

  const Workload& load_;
  const BenchPath& path_;
  int runs_;
  std::unique_ptr<StageSet> host_;
  std::vector<Row> rows_;
};

}  // namespace

std::vector<Row> stageRows(const Workload& load, const BenchPath& path, int runs) {
  return StageRows(load, path, runs).all();
}

}  // namespace rangepose::device_bench
