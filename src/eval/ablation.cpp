#include "eval/ablation.h"

namespace rangepose {
namespace {

AblationRow errorRow(const std::string& name, const std::function<void(ErrorOptions&)>& change) {
  return {name, [change](EstimateOptions& options) { change(options.search.error); }, 0, 0.0};
}

AblationRow areaRow(const std::string& name, AreaFactor area) {
  return errorRow(name, [area](ErrorOptions& error) { error.area = area; });
}

AblationRow lambdaRow(const std::string& name, float lambda) {
  return errorRow(name, [lambda](ErrorOptions& error) { error.lambda = lambda; });
}

AblationRow holesRow(const std::string& name, HolePolicy holes) {
  return errorRow(name, [holes](ErrorOptions& error) { error.holes = holes; });
}

AblationRow limitRow(const std::string& name, float limit_px) {
  return errorRow(name, [limit_px](ErrorOptions& error) { error.range_limit_px = limit_px; });
}

AblationRow spreadRow(const std::string& name, float spread) {
  return {
      name, [spread](EstimateOptions& options) { options.search.simplex.spread = spread; }, 0, 0.0};
}

AblationRow startsRow(const std::string& name, int starts) {
  return {name, [starts](EstimateOptions& options) { options.starts = starts; }, 0, 0.0};
}

AblationRow keptRow(const std::string& name, int kept, int verified) {
  return {name,
          [kept, verified](EstimateOptions& options) {
            options.kept_per_start = kept;
            options.verified = verified;
          },
          0,
          0.0};
}

}  // namespace

std::vector<AblationRow> ablationRows() {
  const auto nothing = [](EstimateOptions&) {};
  return {{"as released", nothing, 0, 0.0},
          areaRow("r_i as printed, A_i / A_max", AreaFactor::kAsPrinted),
          areaRow("r_i none", AreaFactor::kNone),
          areaRow("r_i sqrt(A_max / A_i)", AreaFactor::kRoot),
          lambdaRow("lambda 10", 10.0f),
          lambdaRow("lambda 40", 40.0f),
          holesRow("holes as printed", HolePolicy::kPaper),
          holesRow("holes at the limit", HolePolicy::kLimit),
          limitRow("range limit 4 px", 4.0f),
          limitRow("range limit 16 px", 16.0f),
          limitRow("range limit none (paper)", kNoRangeLimit),
          spreadRow("simplex spread 5 % (paper)", 0.05f),
          spreadRow("simplex spread 0.5 %", 0.005f),
          startsRow("1 start", 1),
          startsRow("6 starts", 6),
          keptRow("64 hypotheses kept of a start", 64, 8),
          keptRow("8 hypotheses kept of a start", 8, 8),
          keptRow("1 hypothesis kept of a start, no choice by the check among them", 1, 1),
          {"references 32 px wide", nothing, 32, 0.0},
          {"references 48 px wide", nothing, 48, 0.0},
          {"references 96 px wide", nothing, 96, 0.0},
          {"scan at 1 mm a pixel", nothing, 0, 1.0},
          {"scan at 2 mm a pixel", nothing, 0, 2.0}};
}

}  // namespace rangepose
