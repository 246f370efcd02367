// What the benchmark runs on: the elbow's views, a heap of elbows, and what the host makes of it.
#pragma once

#include <filesystem>
#include <vector>

#include "database/reference_database.h"
#include "device_bench/report.h"
#include "pipeline/estimate.h"

namespace rangepose::device_bench {

inline constexpr int kSizePx = 64;

/// Reads a binary PLY file of triangles as tools/models.sh writes them. Throws Error for others.
Mesh readModel(const std::filesystem::path& file);

struct Workload {
  /// Views are rendered on the host: the same for each path.
  Workload(int views, int starts);

  const ReferenceObject& object() const { return database.objects.front(); }
  const ObjectTrace& first() const { return trace.objects.front(); }

  ReferenceDatabase database;
  DepthImage depth;  ///< 640x480
  EstimateOptions options;
  Estimate estimate;
  EstimateTrace trace;
  /// Poses of the kept hypotheses with few points each, as the first round of alignment has them.
  std::vector<std::vector<SurfacePoint>> points;
  std::vector<AlignTask> alignments;
  std::vector<JudgeTask> verdicts;
  std::vector<RenderTask> surfaces;

 private:
  void makeTasks();
};

/// Work of a stage on an image of so many pixels.
Work imageWork(const Image<float>& image, double bytes_per_pixel, double operations_per_pixel);

/// Work of the rough search: counts the reference pixels that its simplexes evaluate.
Work searchWork(const Workload& load, StageSet& host);

/// Work of aligning the tasks with the points that they have.
Work alignWork(const Workload& load);

}  // namespace rangepose::device_bench
