// rangepose evaluate: how good a result is.
#include "rangepose/command_evaluate.h"

#include <fmt/format.h>

#include <memory>
#include <system_error>

#include "core/error.h"
#include "core/parallel.h"
#include "rangepose/command.h"
#include "rangepose/console.h"

namespace rangepose::cli {
namespace {

constexpr const char* kExamples =
    R"(With --bop results are measured against the truth of a data set: first pick, recall, precision,
average precision, and the scores of the BOP challenge. With --paper virtual bins of T-pipes,
bolts and elbows are emptied one by one, and the tables of the paper are printed with its figures
beside ours; the models are t_pipe.ply, bolt.ply and elbow.ply of the folder. Each part is a
trial: the one nearest to the pose is taken out, right or wrong; the others stay where they are.

Examples:
  rangepose evaluate --bop bins --csv results.csv
  rangepose evaluate --bop lm --csv results.csv --min-visible 0.3 --out report
  rangepose evaluate --paper models --out report
  rangepose evaluate --paper models --sampling adaptive --sizes 64 --views 1024 --contact-sheet \
      --out report
  rangepose evaluate --paper models --sampling adaptive --sizes 64 --views 1024 --ablation)";

struct EvaluateArguments {
  EvaluateBopArguments bop;
  EvaluatePaperArguments paper;
  std::string out;
  int threads = 0;
};

void checkPaperUsage(EvaluatePaperArguments& paper, const std::string& out) {
  paper.scan.orthographic = paper.camera == "orthographic";
  paper.scan.sensor = sensorModel(paper.sensor);
  if (paper.scan.orthographic && needsPinhole(paper.scan.sensor)) {
    throw UsageError("--sensor " + paper.sensor + " needs --camera perspective");
  }
  if (paper.contact_sheet && out.empty()) throw UsageError("--contact-sheet needs --out DIR");
}

void checkUsage(EvaluateArguments& arguments) {
  if (arguments.bop.folder.empty() == arguments.paper.models.empty()) {
    throw UsageError(arguments.bop.folder.empty()
                         ? "nothing to evaluate; give --bop DIR or --paper MODELS_DIR"
                         : "give either --bop or --paper, not both");
  }
  if (!arguments.paper.models.empty()) {
    checkPaperUsage(arguments.paper, arguments.out);
  } else if (arguments.bop.csv.empty()) {
    throw UsageError("--bop needs a result file; give --csv FILE");
  }
}

int evaluate(EvaluateArguments& arguments) {
  checkUsage(arguments);
  setThreadCount(arguments.threads);
  makeOutputFolder(arguments.out);
  return arguments.paper.models.empty() ? evaluateBop(arguments.bop, arguments.out)
                                        : evaluatePaper(arguments.paper, arguments.out);
}

void declareBop(CLI::App& command, EvaluateBopArguments& bop) {
  command.add_option("--bop", bop.folder, "Data set in the BOP layout, with its truth")
      ->option_text("DIR");
  command.add_option("--csv", bop.csv, "Results: scene_id,im_id,obj_id,score,R,t,time")
      ->option_text("FILE");
  command.add_option("--split", bop.split, "Of the data set")->capture_default_str();
  command
      .add_option("--min-visible",
                  bop.picking.min_visible,
                  "Parts less visible than this share need not be found")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
}

void declarePaper(CLI::App& command, EvaluatePaperArguments& paper) {
  command
      .add_option("--paper", paper.models, "The paper's experiment with the parts of this folder")
      ->option_text("MODELS_DIR");
  command.add_option("--bins", paper.bins, "T-pipes, bolts and elbows by turns; 9 are 210 trials")
      ->check(CLI::Range(1, 999))
      ->capture_default_str();
  command.add_option("--sampling", paper.sampling, "How views are chosen; several: a row each")
      ->delimiter(',')
      ->check(CLI::IsMember({"uniform", "adaptive"}))
      ->capture_default_str();
  command.add_option("--sizes", paper.sizes, "Widths of a view [px]; several: a row each")
      ->delimiter(',')
      ->check(CLI::Range(16, 128))
      ->capture_default_str();
  command.add_option("--views", paper.views, "Views of a part; several: a row each")
      ->delimiter(',')
      ->check(CLI::Range(1, 65536))
      ->capture_default_str();
  command.add_option("--seed", paper.seed, "Of the bins; same seed, same bins")
      ->capture_default_str();
  paper.estimate.starts = 3;  // of the paper
  command.add_option("--starts", paper.estimate.starts, "Start points of the search")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command.add_flag("--contact-sheet", paper.contact_sheet, "A picture of each bin being emptied");
  command.add_flag("--ablation", paper.ablation, "A row for each changed option of the search");
}

void declarePaperScan(CLI::App& command, EvaluatePaperArguments& paper) {
  command.add_option("--camera", paper.camera, "Of the virtual scans, straight above the bin")
      ->check(CLI::IsMember({"orthographic", "perspective"}))
      ->capture_default_str();
  command.add_option("--scan-pixel", paper.scan.pixel_mm, "Pixel of the orthographic scan [mm]")
      ->check(CLI::Range(0.05, 50.0))
      ->capture_default_str();
  command
      .add_option(
          "--sensor",
          paper.sensor,
          "What takes the scans; matching sensors and time of flight need --camera perspective")
      ->check(CLI::IsMember(sensorNames()))
      ->option_text("NAME")
      ->capture_default_str();
  command.add_option("--path", paper.path, "What searches")
      ->check(CLI::IsMember({"auto", "host", "glsl", "cuda"}))
      ->capture_default_str();
  command
      .add_option(
          "--statistics-bins",
          paper.statistics_bins,
          "Bins that adaptive sampling simulates; 0: as many as the file of statistics has, or 500")
      ->check(CLI::Range(0, 100000))
      ->capture_default_str();
}

}  // namespace

void makeOutputFolder(const std::filesystem::path& folder) {
  if (folder.empty()) return;
  std::error_code failure;
  std::filesystem::create_directories(folder, failure);
  std::error_code ignored;
  if (!std::filesystem::is_directory(folder, ignored)) {
    throw Error(fmt::format("output folder {}: cannot be made ({}); name another one by --out",
                            folder.string(),
                            failure ? failure.message() : "not a folder"));
  }
  checkOutputFile(folder / "table.md");
}

std::function<int()> declareEvaluate(CLI::App& command) {
  const auto arguments = std::make_shared<EvaluateArguments>();
  command.footer(kExamples);
  declareBop(command, arguments->bop);
  declarePaper(command, arguments->paper);
  declarePaperScan(command, arguments->paper);
  command
      .add_option(
          "--out", arguments->out, "Also write table.md, table.csv and plots into this folder")
      ->option_text("DIR");
  command.add_option("--threads", arguments->threads, "Of the host; 0: all cores")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  return [arguments] { return evaluate(*arguments); };
}

}  // namespace rangepose::cli
