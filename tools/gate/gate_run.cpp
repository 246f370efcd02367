#include "gate/gate_run.h"

#include <fmt/format.h>

#include <iostream>
#include <numeric>

#include "core/error.h"
#include "eval/grade_bop.h"
#include "gate/content_hash.h"
#include "gate/simulation.h"
#include "io/atomic_file.h"
#include "io/bop.h"
#include "io/file_bytes.h"
#include "rangepose/progress.h"

namespace rangepose::gate {
namespace {

namespace fs = std::filesystem;

/// Result files.
struct AnswerFiles {
  fs::path shown;
  fs::path checked;
};

class CellRun {
 public:
  CellRun(const GatePlan& plan, Cache& cache, const BinKind& kind, const SensorRecipe& sensor)
      : plan_(plan), cache_(cache), kind_(kind), sensor_(sensor) {}

  void makeBins() {
    data_set_ = cache_.dataSet(plan_.simulator,
                               simulationOf(plan_.set, kind_, sensor_, plan_.models),
                               tinySimulation(plan_.set, kind_, sensor_, plan_.models));
  }

  /// Graded once: what it depends on is this program, the bins and the answers.
  CellTallies tallies(const System& system) {
    const AnswerFiles files = system.ppf ? ppfAnswers(system) : rangeposeAnswers(system);
    const std::string key = ContentHash()
                                .add(cache_.hashOf("/proc/self/exe"))
                                .add(data_set_.filename().string())
                                .add(files.shown.filename().string())
                                .add(files.checked.filename().string())
                                .add(std::to_string(kind_.parts.size()))
                                .text();
    const fs::path file = cache_.grades(key);
    if (!fs::exists(file)) writeFileAtomically(file, talliesText(grade(files)));
    constexpr std::uintmax_t kMaxBytes = 1 << 30;
    return talliesFrom(readFileBytes(file, "grades", kMaxBytes), fileLabel("grades", file));
  }

 private:
  fs::path databaseBy(const System& system) {
    return cache_.database(system.program, meshesOf(kind_.parts, plan_.models));
  }

  fs::path answersOf(const System& system,
                     const std::vector<std::string>& options,
                     const fs::path& database) {
    return cache_.answers(system.program, options, database, data_set_);
  }

  AnswerFiles rangeposeAnswers(const System& system) {
    const fs::path database = databaseBy(system);
    const std::vector<std::string> usual = {"estimate", "--all", "--path", "host"};
    std::vector<std::string> low = usual;
    low.insert(low.end(), {"--min-score", fmt::format("{:g}", plan_.low_score)});
    return {answersOf(system, usual, database), answersOf(system, low, database)};
  }

  AnswerFiles ppfAnswers(const System& system) {
    const fs::path database = databaseBy(plan_.systems.front());
    const std::string low = fmt::format("{:g}", plan_.low_score);
    return {answersOf(system, {}, database), answersOf(system, {"--min-score", low}, database)};
  }

  CellTallies grade(const AnswerFiles& files) {
    const BopDataset data = openBop(data_set_);
    const std::vector<BopEstimate> shown = readBopCsv(files.shown);
    const std::vector<BopEstimate> checked = readBopCsv(files.checked);
    GradedRun run;
    for (const BopScene& scene : data.scenes) {
      for (const BopImage& image : scene.images) {
        run.images.emplace_back(scene.scene_id, image.im_id);
      }
    }
    run.shown = graded(data, shown);
    run.checked = graded(data, checked);
    run.times_s = timesOf(shown);
    run.times_s.merge(timesOf(checked));  // where nothing was shown
    return talliesOf(run);
  }

  /// Objects of a database without parts in the bins have ids of other parts there.
  std::vector<ObjectErrors> graded(const BopDataset& data,
                                   const std::vector<BopEstimate>& rows) const {
    return kind_.none ? wrongPoses(rows) : gradeBop(data, rows).images;
  }

  CellTallies talliesOf(const GradedRun& run) const {
    std::set<int> objects;
    for (std::size_t i = 1; i <= kind_.parts.size(); ++i) objects.insert(static_cast<int>(i));
    CellTallies tallies;
    tallies.all = tallyImages(run, objects);
    if (objects.size() < 2 || kind_.none) return tallies;
    for (const int object : objects) tallies.of_part.push_back(tallyImages(run, {object}));
    return tallies;
  }

  const GatePlan& plan_;
  Cache& cache_;
  const BinKind& kind_;
  const SensorRecipe& sensor_;
  fs::path data_set_;
};

}  // namespace

std::vector<GateCell> gateCells(const GatePlan& plan, Cache& cache) {
  RP_CHECK(!plan.systems.empty() && !plan.systems.front().ppf, "gate: no system to run");
  for (const BinKind& kind : plan.kinds) {  // what is missing is told before the work
    for (const SensorRecipe& sensor : plan.sensors) {
      static_cast<void>(simulationOf(plan.set, kind, sensor, plan.models));
    }
    static_cast<void>(meshesOf(kind.parts, plan.models));
  }
  const std::size_t steps = plan.sensors.size() * plan.kinds.size() * (1 + plan.systems.size());
  cli::Progress progress(std::cerr, "gate", static_cast<int>(steps), cli::terminalProgress());
  int done = 0;
  std::vector<GateCell> cells;
  for (const SensorRecipe& sensor : plan.sensors) {
    for (const BinKind& kind : plan.kinds) {
      CellRun run(plan, cache, kind, sensor);
      run.makeBins();
      progress.update(++done);
      cells.push_back({sensor.name, kind, {}});
      for (const System& system : plan.systems) {
        cells.back().systems.push_back(run.tallies(system));
        progress.update(++done);
      }
    }
  }
  return cells;
}

}  // namespace rangepose::gate
