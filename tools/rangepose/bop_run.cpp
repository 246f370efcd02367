#include "rangepose/bop_run.h"

#include <fmt/format.h>

#include <chrono>
#include <iostream>
#include <optional>
#include <set>
#include <vector>

#include "core/error.h"
#include "io/bop.h"
#include "io/depth_file.h"
#include "rangepose/bop_journal.h"
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
         StageSet& stages,
         BopJournal& journal)
      : data_(data),
        database_(database),
        options_(options),
        stages_(stages),
        journal_(journal),
        kept_(static_cast<int>(journal.done().size())),
        progress_(std::cerr, "images", imageCount(data) - kept_, terminalProgress()) {}

  void all() {
    int tried = 0;
    for (const BopScene& scene : data_.scenes) {
      for (const BopImage& image : scene.images) {
        if (journal_.done().count({scene.scene_id, image.im_id}) > 0) continue;
        if (const std::optional<DoneImage> result = estimate(scene, image)) {
          journal_.add({scene.scene_id, image.im_id}, *result);
        }
        progress_.update(++tried);
      }
    }
  }

  int failures() const { return failures_; }

  std::string summary() const {
    int poses = 0;
    double time_s = 0.0;
    for (const auto& [key, image] : journal_.done()) {
      poses += image.poses;
      time_s += image.time_s;
    }
    const std::size_t good = journal_.done().size();
    std::string text = fmt::format("{} of {} images, {} poses, {:.3f} s an image on average",
                                   good,
                                   imageCount(data_),
                                   poses,
                                   good > 0 ? time_s / static_cast<double>(good) : 0.0);
    if (kept_ > 0) text += fmt::format("; {} images from the run before", kept_);
    return text + "\n";
  }

 private:
  /// Empty where the image cannot be read, which is said.
  std::optional<DoneImage> estimate(const BopScene& scene, const BopImage& image) {
    try {
      const DepthImage depth = readDepth(image.depth_path, image.camera);
      const auto begin = std::chrono::steady_clock::now();
      const Estimate found = estimatePoses(depth, image.bin, database_, options_, stages_);
      const std::chrono::duration<double> time = std::chrono::steady_clock::now() - begin;
      for (const std::string& warning : found.warnings) warnOnce(warning);
      return DoneImage{time.count(),
                       static_cast<int>(found.poses.size()),
                       rowsOf(scene.scene_id, image.im_id, found, time.count())};
    } catch (const Error& error) {
      progress_.clear();
      printError(fmt::format("scene {} image {}: {}", scene.scene_id, image.im_id, error.what()));
      ++failures_;
      return std::nullopt;
    }
  }

  std::string rowsOf(int scene_id, int im_id, const Estimate& found, double time_s) const {
    std::vector<BopEstimate> rows;
    for (const PoseEstimate& pose : found.poses) {
      const ReferenceObject& object = database_.objects.at(static_cast<std::size_t>(pose.object));
      rows.push_back({scene_id, im_id, object.id, pose.confidence, pose.pose, time_s});
    }
    return bopCsv(rows).substr(bopCsv({}).size());
  }

  void warnOnce(const std::string& warning) {
    if (!warnings_.insert(warning).second) return;
    progress_.clear();
    printWarning(warning);
  }

  const BopDataset& data_;
  const ReferenceDatabase& database_;
  const EstimateOptions& options_;
  StageSet& stages_;
  BopJournal& journal_;
  int kept_ = 0;  ///< images that an earlier run has done
  Progress progress_;
  int failures_ = 0;
  std::set<std::string> warnings_;
};

/// All that the rows depend on and a user may change.
RunFacts factsOf(const BopArguments& arguments,
                 const std::string& database_file,
                 const EstimateOptions& options,
                 const StageSet& stages,
                 int images) {
  return {{"version", RP_VERSION},
          {"path", stages.name},
          {"database", fmt::format("{:016x}", databaseChecksum(database_file))},
          {"data set", std::filesystem::weakly_canonical(arguments.folder).string()},
          {"split", arguments.split},
          {"images", std::to_string(images)},
          {"--starts", std::to_string(options.starts)},
          {"--max-poses", std::to_string(options.max_poses)},
          {"--min-score", fmt::format("{:.9g}", options.min_score)}};
}

}  // namespace

int runBop(const BopArguments& arguments,
           const std::string& database_file,
           const ReferenceDatabase& database,
           const EstimateOptions& options,
           StageSet& stages) {
  const BopDataset data = openBop(arguments.folder, arguments.split);
  if (data.scenes.empty()) {
    throw Error("BOP data set " + arguments.folder + ": has no scenes in split " + arguments.split +
                "; name another one by --split");
  }
  BopJournal journal(arguments.csv,
                     factsOf(arguments, database_file, options, stages, imageCount(data)),
                     arguments.resume);
  BopRun run(data, database, options, stages, journal);
  run.all();
  journal.finish();
  std::cout << "path " << stages.name << ": " << run.summary();
  return run.failures() > 0 ? kFailed : kDone;
}

}  // namespace rangepose::cli
