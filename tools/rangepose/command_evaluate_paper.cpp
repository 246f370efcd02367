// rangepose evaluate --paper: the paper's experiment and its tables.
#include <fmt/format.h>

#include <iostream>
#include <iterator>
#include <map>
#include <optional>
#include <set>

#include "core/error.h"
#include "debug/canvas.h"
#include "eval/ablation.h"
#include "eval/contact_sheet.h"
#include "eval/failure_pictures.h"
#include "eval/paper_plots.h"
#include "eval/paper_tables.h"
#include "io/atomic_file.h"
#include "pipeline/path_choice.h"
#include "rangepose/build_views.h"
#include "rangepose/command.h"
#include "rangepose/command_evaluate.h"
#include "rangepose/console.h"
#include "rangepose/progress.h"

namespace rangepose::cli {
namespace {

namespace fs = std::filesystem;

class PaperEvaluation {
 public:
  PaperEvaluation(const EvaluatePaperArguments& arguments, const fs::path& out)
      : arguments_(arguments), out_(out) {
    // Each trial has an answer, as in the paper.
    options_ = arguments.estimate;
    options_.min_score = 0.0;
    Progress progress(std::cerr, "dropping bins", arguments.bins, terminalProgress());
    models_ =
        paperModels(arguments.models, arguments.bins, arguments.seed, [&progress](int done, int) {
          progress.update(done);
        });
  }

  std::vector<SettingRun> runAll() {
    const std::vector<PaperSetting> settings = settingsOf();
    if (!out_.empty()) {
      makeOutputFolder(out_ / "failures");
      failures_.emplace(out_ / "failures");
    }
    const int trials = trialCount(models_) * static_cast<int>(settings.size());
    Progress progress(std::cerr, "trials", trials, terminalProgress());
    std::vector<SettingRun> runs;
    int done = 0;
    for (const PaperSetting& setting : settings) {
      const bool sheets = arguments_.contact_sheet && setting == settings.back();
      const auto observe = [&](const PaperModel& model,
                               const Trial& trial,
                               const BinScan& scan,
                               const TrialAnswer& answer) {
        progress.update(++done);
        if (failures_)
          failures_->add(setting, model.name, model.errors.mesh(), trial, scan, answer);
        if (sheets) addToSheet(model, setting, trial, scan, answer);
      };
      runs.push_back(run(setting, options_, arguments_.scan, observe));
    }
    if (failures_) writeFileAtomically(out_ / "failures" / "index.md", failures_->markdown());
    writeSheets();
    return runs;
  }

  /// The last setting with one option changed after the other.
  std::string ablationTable() {
    std::vector<AblationRow> rows = ablationRows();
    if (!arguments_.scan.orthographic) {  // its pixels are not of one width
      std::erase_if(rows, [](const AblationRow& row) { return row.scan_mm > 0.0; });
    }
    const PaperSetting base = settingsOf().back();
    std::string text = fmt::format(
        "\n### Ablation: {}\n\n| changed | trials | Eq. 1 alone right [%] | aligned with its view "
        "right "
        "[%] | refined right [%] | vertex error [%] | time [s] |\n|---|---|---|---|---|---|---|\n",
        settingName(base));
    Progress progress(std::cerr,
                      "ablation",
                      trialCount(models_) * static_cast<int>(rows.size()),
                      terminalProgress());
    int done = 0;
    for (const AblationRow& row : rows) {
      PaperSetting setting = base;
      if (row.size > 0) setting.size = row.size;
      BinScanOptions scan = arguments_.scan;
      if (row.scan_mm > 0.0) scan.pixel_mm = row.scan_mm;
      EstimateOptions options = options_;
      row.change(options);
      const auto observe =
          [&](const PaperModel&, const Trial&, const BinScan&, const TrialAnswer&) {
            progress.update(++done);
          };
      text += ablationLine(row.name, allTrials(run(setting, options, scan, observe)));
    }
    return text;
  }

  int trials() const { return trialCount(models_); }

  /// Where adaptive views come from; a line each.
  std::string notes() const {
    std::string text;
    for (const std::string& note : notes_) text += "- views of " + note + "\n";
    return text.empty() ? text : text + "\n";
  }

 private:
  using Observe =
      std::function<void(const PaperModel&, const Trial&, const BinScan&, const TrialAnswer&)>;

  std::vector<PaperSetting> settingsOf() const {
    std::vector<PaperSetting> settings;
    for (const int views : arguments_.views) {
      for (const std::string& sampling : arguments_.sampling) {
        for (const int size : arguments_.sizes) settings.push_back({sampling, size, views});
      }
    }
    return settings;
  }

  SettingRun run(const PaperSetting& setting,
                 const EstimateOptions& options,
                 const BinScanOptions& scan,
                 const Observe& observe) {
    SettingRun result{setting, {}};
    for (const auto& model : models_) {
      const ReferenceDatabase database =
          referencesOf(*model, setting.size, viewsOf(*model, setting));
      // Stages keep a copy of the references that they have searched.
      const PathStages path = openPath(parsePathRequest(arguments_.path));
      const auto see = [&](const Trial& trial, const BinScan& scanned, const TrialAnswer& answer) {
        observe(*model, trial, scanned, answer);
      };
      result.models.push_back(runModel(*model, database, options, scan, *path.stages, see));
    }
    return result;
  }

  /// Statistics of adaptive views come from the file beside the mesh; simulated ones are kept.
  std::vector<glm::dmat3> viewsOf(const PaperModel& model, const PaperSetting& setting) {
    ViewRequest request;
    request.adaptive = setting.sampling == "adaptive";
    request.views = setting.views;
    request.bins = arguments_.statistics_bins;
    request.folder = out_.empty() ? fs::path(".") : out_;
    ChosenViews views =
        chooseViews(request, model.mesh_path, model.errors.mesh(), model.errors.symmetries());
    if (!views.note.empty()) notes_.insert(views.note);
    return views.rotations;
  }

  static std::string ablationLine(const std::string& name, const std::vector<Trial>& trials) {
    const GradeSummary search = summarize(trials, &Trial::search);
    const GradeSummary rough = summarize(trials, &Trial::rough);
    const GradeSummary fine = summarize(trials, &Trial::fine);
    double ms = 0.0;
    for (const StageTime& time : meanTimes(trials)) ms += time.ms;
    const auto percent = [](const GradeSummary& summary) {
      return 100.0 * summary.right / summary.trials;
    };
    return fmt::format("| {} | {} | {:.1f} | {:.1f} | {:.1f} | {:.3f} | {:.3f} |\n",
                       name,
                       fine.trials,
                       percent(search),
                       percent(rough),
                       percent(fine),
                       fine.vertex_percent,
                       1.0e-3 * ms);
  }

  void addToSheet(const PaperModel& model,
                  const PaperSetting& setting,
                  const Trial& trial,
                  const BinScan& scan,
                  const TrialAnswer& answer) {
    const std::string name = fmt::format("sheet_bin{}_{}.png", trial.bin, model.name);
    const auto [sheet, is_new] = sheets_.try_emplace(
        name,
        model.errors.mesh(),
        fmt::format("Bin {}: {}, {}", trial.bin, model.name, settingName(setting)));
    sheet->second.add(trial, scan, answer);
  }

  void writeSheets() const {
    for (const auto& [name, sheet] : sheets_) debug::writePng(out_ / name, sheet.picture());
  }

  const EvaluatePaperArguments& arguments_;
  const fs::path out_;
  EstimateOptions options_;
  PaperModels models_;
  std::set<std::string> notes_;
  std::optional<FailurePictures> failures_;
  std::map<std::string, ContactSheet> sheets_;
};

}  // namespace

int evaluatePaper(const EvaluatePaperArguments& arguments, const std::string& out) {
  PaperEvaluation evaluation(arguments, out);
  const std::vector<SettingRun> runs = evaluation.runAll();
  std::string markdown =
      fmt::format("{} trials in {} virtual bins, seed {}, {} scan{}, {} starts, path {}.\n\n",
                  evaluation.trials(),
                  arguments.bins,
                  arguments.seed,
                  arguments.camera,
                  arguments.sensor == "none" ? "" : " by " + arguments.sensor,
                  arguments.estimate.starts,
                  arguments.path);
  markdown += evaluation.notes() + paperMarkdown(runs);
  if (arguments.ablation) markdown += evaluation.ablationTable();
  if (!out.empty()) {
    const fs::path folder = out;
    writeFileAtomically(folder / "table.md", markdown);
    writeFileAtomically(folder / "table.csv", trialsCsv(runs));
    writePaperPlots(folder, runs);
  }
  std::cout << markdown;
  return kDone;
}

}  // namespace rangepose::cli
