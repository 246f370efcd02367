#include "fit/table_run.h"

#include <algorithm>
#include <iostream>
#include <iterator>
#include <memory>

#include "core/parallel.h"
#include "database/reference_database.h"
#include "eval/matching.h"
#include "eval/pose_errors.h"
#include "eval/vsd.h"
#include "gate/simulation.h"
#include "geometry/symmetry.h"
#include "io/bop.h"
#include "io/bop_truth.h"
#include "io/depth_file.h"
#include "io/mesh_file.h"
#include "pipeline/estimate.h"
#include "rangepose/progress.h"

namespace rangepose::fit {
namespace {

namespace fs = std::filesystem;

/// The true poses of the parts of the database in an image.
struct Truth {
  std::vector<BopTruth> parts;

  Truth(const gate::BinKind& kind, const std::vector<BopTruth>& all) {
    // Ids of a bin without parts of the database are those of other parts.
    if (kind.none) return;
    std::copy_if(all.begin(), all.end(), std::back_inserter(parts), [&](const BopTruth& one) {
      return one.obj_id <= static_cast<int>(kind.parts.size());
    });
  }
};

class KindRun {
 public:
  KindRun(const TablePlan& plan,
          gate::Cache& cache,
          const gate::SensorRecipe& sensor,
          const gate::BinKind& kind)
      : sensor_(sensor), kind_(kind) {
    data_set_ = cache.dataSet(plan.program,
                              simulationOf(plan.set, kind, sensor, plan.models),
                              tinySimulation(plan.set, kind, sensor, plan.models));
    const std::vector<fs::path> meshes = gate::meshesOf(kind.parts, plan.models);
    database_ = readDatabase(cache.database(plan.program, meshes));
    for (const fs::path& path : meshes) {
      const Mesh mesh = readMesh(path, LengthUnit::kMillimetre);
      models_.push_back(std::make_unique<ErrorModel>(mesh, findSymmetries(mesh)));
    }
  }

  void addTo(std::vector<EvidenceRow>& rows, StageSet& stages) const {
    for (const BopScene& scene : openBop(data_set_).scenes) {
      const auto truths = readBopTruth(scene.folder);
      for (const BopImage& image : scene.images) {
        const DepthImage depth = readDepth(image.depth_path, image.camera);
        const std::vector<EvidenceRow> own =
            rowsOf(depth, image, Truth(kind_, truths.at(image.im_id)), stages);
        rows.insert(rows.end(), own.begin(), own.end());
        for (auto row = rows.end() - static_cast<std::ptrdiff_t>(own.size()); row != rows.end();
             ++row)
          row->scene = scene.scene_id;
      }
    }
  }

 private:
  std::vector<EvidenceRow> rowsOf(const DepthImage& depth,
                                  const BopImage& image,
                                  const Truth& truth,
                                  StageSet& stages) const {
    EstimateOptions options;
    options.max_poses = 1000;
    EstimateTrace trace;
    static_cast<void>(estimatePoses(depth, image.bin, database_, options, stages, &trace));
    const Image<float> distances = distancesOf(depth);
    std::vector<EvidenceRow> rows(trace.known.size());
    parallelForEach(rows.size(), 1, [&](std::size_t i) {
      const Candidate& candidate = trace.known[i];
      EvidenceRow& row = rows[i];
      row.sensor = sensor_.name;
      row.kind = kind_.name;
      row.image = image.im_id;
      row.object = database_.objects[static_cast<std::size_t>(candidate.object)].id;
      row.right = isRight(candidate, truth, depth.camera, distances);
      row.score = candidate.confidence;
      row.inner_px = candidate.check.inner_px;
      row.terms = candidate.evidence;
      for (const Candidate& one : trace.chosen) {
        if (one.object != candidate.object || one.pose.rotation != candidate.pose.rotation ||
            one.pose.translation_mm != candidate.pose.translation_mm)
          continue;
        row.chosen = true;
        row.score = one.confidence;
      }
    });
    return rows;
  }

  bool isRight(const Candidate& candidate,
               const Truth& truth,
               const Camera& camera,
               const Image<float>& distances) const {
    constexpr double kRight = 0.1;     // of the diameter
    constexpr double kUnlike = 0.005;  // see PickingOptions
    constexpr double kFar = 0.5;       // of the diameter: nothing alike
    const auto object = static_cast<std::size_t>(candidate.object);
    const ErrorModel& model = *models_[object];
    for (const BopTruth& one : truth.parts) {
      if (one.obj_id != database_.objects[object].id) continue;
      const Pose& true_pose = one.camera_from_object;
      const double diameter_mm = model.diameterMm();
      const Pose off = true_pose.inverse() * candidate.pose;
      if (glm::distance(off * model.sphere().center_mm, model.sphere().center_mm) >
          kFar * diameter_mm)
        continue;
      if (mssdErrorMm(model, candidate.pose, true_pose, kFar * diameter_mm) < kRight * diameter_mm)
        return true;
      if (unlikeness(distances,
                     renderPosed(model.mesh(), camera, candidate.pose),
                     renderPosed(model.mesh(), camera, true_pose),
                     kLookApart * diameter_mm) < kUnlike)
        return true;
    }
    return false;
  }

  const gate::SensorRecipe& sensor_;
  const gate::BinKind& kind_;
  fs::path data_set_;
  ReferenceDatabase database_;
  std::vector<std::unique_ptr<ErrorModel>> models_;
};

}  // namespace

std::vector<EvidenceRow> evidenceTable(const TablePlan& plan, gate::Cache& cache) {
  const auto stages = makeHostStages();
  const std::size_t steps = plan.sensors.size() * plan.set.kinds.size();
  cli::Progress progress(std::cerr, "bins", static_cast<int>(steps), cli::terminalProgress());
  int done = 0;
  std::vector<EvidenceRow> rows;
  for (const gate::SensorRecipe& sensor : plan.sensors) {
    for (const gate::BinKind& kind : plan.set.kinds) {
      KindRun(plan, cache, sensor, kind).addTo(rows, *stages);
      progress.update(++done);
    }
  }
  return rows;
}

}  // namespace rangepose::fit
