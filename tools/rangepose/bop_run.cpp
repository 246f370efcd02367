#include "rangepose/bop_run.h"

#include <fmt/format.h>

#include <chrono>
#include <iostream>
#include <set>
#include <vector>

#include "core/error.h"
#include "io/bop.h"
#include "io/depth_file.h"
#include "rangepose/command.h"
#include "rangepose/console.h"
#include "rangepose/progress.h"

namespace rangepose::cli {
namespace {

class BopRun {
 public:
  BopRun(const BopDataset& data,
         const ReferenceDatabase& database,
         const EstimateOptions& options,
         StageSet& stages)
      : database_(database),
        options_(options),
        stages_(stages),
        total_(countImages(data)),
        progress_(std::cerr, "images", total_, terminalProgress()) {}

  void add(const BopScene& scene, const BopImage& image) {
    try {
      const DepthImage depth = readDepth(image.depth_path, image.camera);
      const auto begin = std::chrono::steady_clock::now();
      const Estimate estimate = estimatePoses(depth, image.bin, database_, options_, stages_);
      const std::chrono::duration<double> time = std::chrono::steady_clock::now() - begin;
      total_time_s_ += time.count();
      addRows(scene.scene_id, image.im_id, estimate, time.count());
      for (const std::string& warning : estimate.warnings) warnOnce(warning);
    } catch (const Error& error) {
      progress_.clear();
      printError(fmt::format("scene {} image {}: {}", scene.scene_id, image.im_id, error.what()));
      ++failures_;
    }
    progress_.update(++done_);
  }

  int failures() const { return failures_; }
  const std::vector<BopEstimate>& rows() const { return rows_; }

  std::string summary() const {
    const int good = done_ - failures_;
    return fmt::format("{} of {} images, {} poses, {:.3f} s an image on average\n",
                       good,
                       total_,
                       rows_.size(),
                       good > 0 ? total_time_s_ / good : 0.0);
  }

 private:
  static int countImages(const BopDataset& data) {
    std::size_t count = 0;
    for (const BopScene& scene : data.scenes) count += scene.images.size();
    return static_cast<int>(count);
  }

  void addRows(int scene_id, int im_id, const Estimate& estimate, double time_s) {
    for (const PoseEstimate& pose : estimate.poses) {
      const ReferenceObject& object = database_.objects.at(static_cast<std::size_t>(pose.object));
      rows_.push_back({scene_id, im_id, object.id, pose.confidence, pose.pose, time_s});
    }
  }

  void warnOnce(const std::string& warning) {
    if (!warnings_.insert(warning).second) return;
    progress_.clear();
    printWarning(warning);
  }

  const ReferenceDatabase& database_;
  const EstimateOptions& options_;
  StageSet& stages_;
  int total_ = 0;
  Progress progress_;
  int done_ = 0;
  int failures_ = 0;
  double total_time_s_ = 0.0;
  std::vector<BopEstimate> rows_;
  std::set<std::string> warnings_;
};

}  // namespace

int runBop(const BopArguments& arguments,
           const ReferenceDatabase& database,
           const EstimateOptions& options,
           StageSet& stages) {
  const BopDataset data = openBop(arguments.folder, arguments.split);
  if (data.scenes.empty()) {
    throw Error("BOP data set " + arguments.folder + ": has no scenes in split " + arguments.split +
                "; name another one by --split");
  }
  BopRun run(data, database, options, stages);
  for (const BopScene& scene : data.scenes) {
    for (const BopImage& image : scene.images) run.add(scene, image);
  }
  writeBopCsv(arguments.csv, run.rows());
  std::cout << "path " << stages.name() << ": " << run.summary();
  return run.failures() > 0 ? kFailed : kDone;
}

}  // namespace rangepose::cli
