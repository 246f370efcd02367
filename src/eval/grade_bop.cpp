#include "eval/grade_bop.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <utility>

#include "core/error.h"
#include "core/parallel.h"
#include "eval/grade_image.h"
#include "io/bop_truth.h"
#include "io/depth_file.h"
#include "io/mesh_file.h"

namespace rangepose {
namespace {

/// Truths less visible than this are no targets where there is no list of them (BOP's rule).
constexpr double kTargetVisible = 0.1;

using ImageId = std::pair<int, int>;

struct ImageJob {
  int scene_id = 0;
  const BopImage* image = nullptr;
  std::vector<BopTruth> truths;
  std::vector<const BopEstimate*> rows;
};

std::vector<ImageJob> jobsOf(const BopDataset& data, const std::vector<BopEstimate>& rows) {
  std::vector<ImageJob> jobs;
  std::map<ImageId, std::size_t> known;
  for (const BopScene& scene : data.scenes) {
    const std::map<int, std::vector<BopTruth>> truth = readBopTruth(scene.folder);
    for (const BopImage& image : scene.images) {
      const auto found = truth.find(image.im_id);
      if (found == truth.end()) {
        throw Error(fmt::format("truth {}: image {} is missing; scene_camera.json has it",
                                (scene.folder / "scene_gt.json").string(),
                                image.im_id));
      }
      known[{scene.scene_id, image.im_id}] = jobs.size();
      jobs.push_back({scene.scene_id, &image, found->second, {}});
    }
  }
  for (const BopEstimate& row : rows) {
    const auto found = known.find({row.scene_id, row.im_id});
    if (found == known.end()) {
      throw Error(
          fmt::format("results: scene {} image {} is not in the data set {}; check the split and "
                      "the target list",
                      row.scene_id,
                      row.im_id,
                      data.folder.string()));
    }
    jobs[found->second].rows.push_back(&row);
  }
  return jobs;
}

std::vector<BopModel> modelsOf(const BopDataset& data) {
  const std::filesystem::path folder = data.folder / "models_eval";
  std::error_code failure;
  return std::filesystem::is_directory(folder, failure) ? readBopModels(folder) : data.models;
}

using Models = std::map<int, std::unique_ptr<ErrorModel>>;

/// Models of all objects that truth or results name.
Models readModels(const BopDataset& data, const std::vector<ImageJob>& jobs) {
  std::map<int, std::string> wanted;
  for (const ImageJob& job : jobs) {
    for (const BopTruth& truth : job.truths) wanted.try_emplace(truth.obj_id, "truth");
    for (const BopEstimate* row : job.rows) wanted.try_emplace(row->obj_id, "results");
  }
  Models models;
  for (const BopModel& model : modelsOf(data)) {
    if (!wanted.contains(model.obj_id)) continue;
    const Mesh mesh = readMesh(model.mesh_path, LengthUnit::kMillimetre);
    const Symmetries symmetries = model.info ? symmetriesOf(*model.info) : findSymmetries(mesh);
    models[model.obj_id] = std::make_unique<ErrorModel>(mesh, symmetries);
  }
  for (const auto& [id, origin] : wanted) {
    if (models.contains(id)) continue;
    throw Error(fmt::format("{}: object {} has no model in {}; expected models/obj_{:06}.ply",
                            origin,
                            id,
                            data.folder.string(),
                            id));
  }
  return models;
}

/// Truth and estimates of one object in one image.
ImageGrading gradingOf(const ImageJob& job, int obj_id) {
  ImageGrading grading;
  grading.errors.scene_id = job.scene_id;
  grading.errors.im_id = job.image->im_id;
  grading.errors.obj_id = obj_id;
  int visible_enough = 0;
  for (const BopTruth& truth : job.truths) {
    if (truth.obj_id != obj_id) continue;
    const double visible = truth.visible_fraction.value_or(1.0);
    visible_enough += visible >= kTargetVisible ? 1 : 0;
    grading.truths.push_back(truth.camera_from_object);
    grading.errors.visible_fractions.push_back(visible);
  }
  int listed = 0;
  for (const BopTarget& target : job.image->targets) {
    listed += target.obj_id == obj_id ? target.inst_count : 0;
  }
  grading.errors.targets = job.image->targets.empty()
                               ? visible_enough
                               : std::min<int>(listed, static_cast<int>(grading.truths.size()));
  std::vector<const BopEstimate*> rows;
  for (const BopEstimate* row : job.rows) {
    if (row->obj_id == obj_id) rows.push_back(row);
  }
  std::stable_sort(rows.begin(), rows.end(), [](const BopEstimate* a, const BopEstimate* b) {
    return a->score > b->score;
  });
  for (const BopEstimate* row : rows) {
    grading.estimates.push_back(row->camera_from_object);
    grading.errors.scores.push_back(row->score);
  }
  return grading;
}

std::vector<ObjectErrors> gradeJob(const ImageJob& job,
                                   const Models& models,
                                   const VsdOptions& vsd) {
  std::set<int> ids;
  for (const BopTruth& truth : job.truths) ids.insert(truth.obj_id);
  for (const BopEstimate* row : job.rows) ids.insert(row->obj_id);
  if (ids.empty()) return {};
  const DepthImage depth = readDepth(job.image->depth_path, job.image->camera);
  const Image<float> measured = distancesOf(depth);
  std::vector<ObjectErrors> errors;
  for (const int id : ids) {
    ImageGrading grading = gradingOf(job, id);
    fillErrors(grading, *models.at(id), depth.camera, measured, vsd);
    errors.push_back(std::move(grading.errors));
  }
  return errors;
}

double meanTime(const std::vector<ImageJob>& jobs) {
  double sum = 0.0;
  int count = 0;
  for (const ImageJob& job : jobs) {
    if (job.rows.empty() || job.rows.front()->time_s < 0.0) continue;
    sum += job.rows.front()->time_s;
    ++count;
  }
  return count == 0 ? std::numeric_limits<double>::quiet_NaN() : sum / count;
}

void addWarnings(const std::vector<ImageJob>& jobs, GradedResults& results) {
  const bool unknown = std::any_of(jobs.begin(), jobs.end(), [](const ImageJob& job) {
    return std::any_of(job.truths.begin(), job.truths.end(), [](const BopTruth& truth) {
      return !truth.visible_fraction.has_value();
    });
  });
  if (unknown) {
    results.warnings.push_back("no scene_gt_info.json: all parts count as fully visible");
  }
}

}  // namespace

Symmetries symmetriesOf(const BopModelInfo& info) {
  Symmetries symmetries;
  symmetries.discrete = info.symmetries_discrete;
  for (const BopContinuousSymmetry& line : info.symmetries_continuous) {
    symmetries.continuous.push_back({line.axis, line.offset_mm});
  }
  return symmetries;
}

GradedResults gradeBop(const BopDataset& data,
                       const std::vector<BopEstimate>& rows,
                       const VsdOptions& vsd,
                       const std::function<void(int done, int total)>& progress) {
  vsd.check();
  const std::vector<ImageJob> jobs = jobsOf(data, rows);
  if (jobs.empty()) {
    throw Error(
        fmt::format("BOP data {}: no image to evaluate; check the split", data.folder.string()));
  }
  const Models models = readModels(data, jobs);
  const int total = static_cast<int>(jobs.size());
  std::vector<std::vector<ObjectErrors>> graded(jobs.size());
  std::mutex mutex;
  int done = 0;
  parallelFor(total, 1, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      const auto index = static_cast<std::size_t>(i);
      graded[index] = gradeJob(jobs[index], models, vsd);
      const std::lock_guard lock(mutex);
      if (progress) progress(++done, total);
    }
  });
  GradedResults results;
  results.image_count = total;
  results.mean_time_s = meanTime(jobs);
  for (const auto& [id, model] : models) {
    results.objects.push_back(
        {id, model->mesh().name, model->diameterMm(), model->copies().size()});
  }
  for (std::vector<ObjectErrors>& image : graded) {
    std::move(image.begin(), image.end(), std::back_inserter(results.images));
  }
  addWarnings(jobs, results);
  return results;
}

}  // namespace rangepose
