// The paper's 210 trials: nine bins, emptied one by one for each setting of the search.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "eval/emptying.h"
#include "eval/paper_figures.h"
#include "pipeline/estimate.h"

namespace rangepose {

/// A part of the experiment with its bins. Does not move: bins point to the mesh.
struct PaperModel {
  PaperModel(const Mesh& mesh, const Symmetries& symmetries) : errors(mesh, symmetries) {}
  PaperModel(const PaperModel&) = delete;
  PaperModel& operator=(const PaperModel&) = delete;

  std::string name;
  std::filesystem::path mesh_path;
  ErrorModel errors;
  std::vector<VirtualBin> bins;
};

using PaperModels = std::vector<std::unique_ptr<PaperModel>>;

/// Bins of 20 t_pipe, 30 bolt and 20 elbow by turns, made by dropping the parts (sim/drop.h), each
/// once for all settings; nine bins are the paper's. `models` holds t_pipe.ply, bolt.ply and
/// elbow.ply; ones without a bin are left out. `progress(done, total)` may be empty.
PaperModels paperModels(const std::filesystem::path& models,
                        int bins,
                        std::uint64_t seed,
                        const std::function<void(int done, int total)>& progress);

/// Number of trials in all bins.
int trialCount(const PaperModels& models);

/// One model, one setting.
struct ModelRun {
  std::string model;
  std::vector<Trial> trials;
  double atlas_mb = 0.0;  ///< references as one RGBA32F texture (10^6 bytes)
};

struct SettingRun {
  PaperSetting setting;
  std::vector<ModelRun> models;
};

/// The references of one model: views, rendered on the host.
ReferenceDatabase referencesOf(const PaperModel& model,
                               int size,
                               const std::vector<glm::dmat3>& views);

/// The answer of the pipeline to a scan: the hypothesis with the smallest error of all, also with
/// range differences that count without limit, and the first pose. With `timed` the scan is
/// estimated a second time, without a trace, for its times.
TrialAnswer answerOf(const BinScan& scan,
                     const ReferenceDatabase& database,
                     const EstimateOptions& options,
                     StageSet& stages,
                     bool timed);

/// Empties all bins of a model. Every fifth trial is timed.
ModelRun runModel(const PaperModel& model,
                  const ReferenceDatabase& database,
                  const EstimateOptions& options,
                  const BinScanOptions& scan,
                  StageSet& stages,
                  const TrialObserver& observe);

}  // namespace rangepose
