// The images of a data set, one after the other, with what is known of them.
#include <fmt/format.h>

#include <map>
#include <system_error>

#include "core/error.h"
#include "core/parallel.h"
#include "eval/scan_statistics.h"
#include "io/bop_truth.h"
#include "io/depth_file.h"
#include "io/mesh_file.h"

namespace rangepose {
namespace {

constexpr double kLeastVisible = 0.5;

struct Model {
  Mesh mesh;
  double diameter_mm = 0.0;
};

struct ScanJob {
  const BopImage* image = nullptr;
  std::vector<BopTruth> truths;
};

std::map<int, std::vector<BopTruth>> ownTruth(const BopScene& scene) {
  const std::filesystem::path path = scene.folder / "scene_gt.json";
  std::error_code failure;
  if (std::filesystem::exists(path, failure)) return readBopTruth(scene.folder);
  throw Error(fmt::format("truth {}: no such file; name one by --truth", path.string()));
}

/// Images with poses.
std::vector<ScanJob> jobsOf(const BopDataset& data, const ScanSet& set) {
  if (set.truth && data.scenes.size() > 1) {
    throw Error(fmt::format("truth {}: one file cannot tell the {} scenes of {} apart",
                            set.truth->string(),
                            data.scenes.size(),
                            set.folder.string()));
  }
  std::vector<ScanJob> jobs;
  for (const BopScene& scene : data.scenes) {
    const std::map<int, std::vector<BopTruth>> truths =
        set.truth ? readBopTruthFile(*set.truth) : ownTruth(scene);
    for (const BopImage& image : scene.images) {
      const auto found = truths.find(image.im_id);
      if (found != truths.end() && !found->second.empty()) jobs.push_back({&image, found->second});
    }
  }
  return jobs;
}

std::map<int, Model> modelsOf(const BopDataset& data, const std::vector<ScanJob>& jobs) {
  std::map<int, Model> models;
  for (const ScanJob& job : jobs) {
    for (const BopTruth& truth : job.truths) models.try_emplace(truth.obj_id);
  }
  for (const BopModel& file : data.models) {
    const auto wanted = models.find(file.obj_id);
    if (wanted == models.end()) continue;
    wanted->second.mesh = readMesh(file.mesh_path, LengthUnit::kMillimetre);
    wanted->second.diameter_mm = diameter(wanted->second.mesh);
  }
  for (const auto& [id, model] : models) {
    if (model.diameter_mm > 0.0) continue;
    throw Error(fmt::format("truth: object {} has no model in {}; expected models/obj_{:06}.ply",
                            id,
                            data.folder.string(),
                            id));
  }
  return models;
}

ScanTally tallyJob(const ScanJob& job, const std::map<int, Model>& models) {
  std::vector<KnownPart> parts;
  for (const BopTruth& truth : job.truths) {
    const Model& model = models.at(truth.obj_id);
    parts.push_back({&model.mesh,
                     model.diameter_mm,
                     truth.camera_from_object,
                     truth.visible_fraction.value_or(1.0) >= kLeastVisible});
  }
  return tallyScan(readDepth(job.image->depth_path, job.image->camera), parts);
}

/// The folder's own name.
std::string nameOf(const std::filesystem::path& folder) {
  const std::filesystem::path plain = std::filesystem::absolute(folder).lexically_normal();
  return (plain.has_filename() ? plain : plain.parent_path()).stem().string();
}

}  // namespace

ScanStatistics measureScans(const ScanSet& set) {
  const BopDataset data = openBop(set.folder, set.split);
  const std::vector<ScanJob> jobs = jobsOf(data, set);
  const std::map<int, Model> models = modelsOf(data, jobs);
  std::vector<ScanTally> tallies(jobs.size());
  parallelForEach(jobs.size(), 1, [&](std::size_t i) { tallies[i] = tallyJob(jobs[i], models); });
  ScanTally all;
  for (const ScanTally& tally : tallies) all.add(tally);
  if (all.parts == 0) {
    throw Error(fmt::format(
        "scans {}: no image has a part of known pose that is half visible; check split and truth",
        set.folder.string()));
  }
  ScanStatistics statistics = statisticsOf(all);
  statistics.name = nameOf(set.folder);
  return statistics;
}

}  // namespace rangepose
