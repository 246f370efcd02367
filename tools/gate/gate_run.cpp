#include "gate/gate_run.h"

#include <fmt/format.h>

#include <iostream>
#include <numeric>

#include "core/error.h"
#include "eval/grade_bop.h"
#include "gate/simulation.h"
#include "io/bop.h"
#include "rangepose/progress.h"

namespace rangepose::gate {
namespace {

namespace fs = std::filesystem;

struct Answers {
  std::vector<BopEstimate> shown;
  std::vector<BopEstimate> checked;
};

class CellRun {
 public:
  CellRun(const GatePlan& plan, Cache& cache, const BinKind& kind, const SensorRecipe& sensor)
      : plan_(plan), cache_(cache), kind_(kind), sensor_(sensor) {}

  void makeBins() {
    data_set_ = cache_.dataSet(plan_.simulator,
                               simulationOf(plan_.set, kind_, sensor_, plan_.models),
                               tinySimulation(plan_.set, kind_, sensor_, plan_.models));
    data_ = openBop(data_set_);
  }

  CellTallies tallies(const System& system) {
    const Answers answers = system.ppf ? ppfAnswers(system) : rangeposeAnswers(system);
    GradedRun run;
    for (const BopScene& scene : data_.scenes) {
      for (const BopImage& image : scene.images) {
        run.images.emplace_back(scene.scene_id, image.im_id);
      }
    }
    run.shown = graded(answers.shown);
    run.checked = graded(answers.checked);
    run.times_s = timesOf(answers.shown);
    run.times_s.merge(timesOf(answers.checked));  // where nothing was shown
    return talliesOf(run);
  }

 private:
  fs::path databaseBy(const System& system) {
    return cache_.database(system.program, meshesOf(kind_.parts, plan_.models));
  }

  std::vector<BopEstimate> answersOf(const System& system,
                                     const std::vector<std::string>& options,
                                     const fs::path& database) {
    return readBopCsv(cache_.answers(system.program, options, database, data_set_));
  }

  Answers rangeposeAnswers(const System& system) {
    const fs::path database = databaseBy(system);
    const std::vector<std::string> usual = {"estimate", "--all", "--path", "host"};
    std::vector<std::string> low = usual;
    low.insert(low.end(), {"--min-score", fmt::format("{:g}", plan_.low_score)});
    return {answersOf(system, usual, database), answersOf(system, low, database)};
  }

  Answers ppfAnswers(const System& system) {
    const fs::path database = databaseBy(plan_.systems.front());
    const std::string low = fmt::format("{:g}", plan_.low_score);
    return {answersOf(system, {}, database), answersOf(system, {"--min-score", low}, database)};
  }

  /// Objects of a database without parts in the bins have ids of other parts there.
  std::vector<ObjectErrors> graded(const std::vector<BopEstimate>& rows) const {
    return kind_.none ? wrongPoses(rows) : gradeBop(data_, rows).images;
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
  BopDataset data_;
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
