#include "gate/gate_report.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <cmath>
#include <ctime>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

namespace rangepose::gate {
namespace {

using Json = nlohmann::ordered_json;

std::string processorName() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    const std::size_t colon = line.find(": ");
    if (line.rfind("model name", 0) == 0 && colon != std::string::npos) {
      return line.substr(colon + 2);
    }
  }
  return "unknown";
}

std::string loadNow() {
  std::ifstream file("/proc/loadavg");
  std::string one;
  return file >> one ? one : "unknown";
}

Json number(double value) { return std::isnan(value) ? Json() : Json(value); }

Json figuresJson(const GateFigures& figures) {
  Json object = Json::object();
  for (const GateColumn& column : gateColumns()) {
    object[column.key] = number(column.value(figures));
  }
  Json tenths = Json::array();
  for (const ReliabilityBin& bin : figures.reliability) {
    tenths.push_back({{"low", bin.low},
                      {"high", bin.high},
                      {"poses", bin.count},
                      {"mean_score", number(bin.mean_score)},
                      {"right", number(bin.right)}});
  }
  object["calibration"] = std::move(tenths);
  return object;
}

Json differenceJson(const GateDifference& difference) {
  Json object = Json::object();
  for (const FigureDifference& figure : difference.figures) {
    object[figure.column->key] = {{"before", number(figure.before)},
                                  {"after", number(figure.after)},
                                  {"change", number(figure.change())},
                                  {"low", number(figure.interval.low)},
                                  {"high", number(figure.interval.high)},
                                  {"clear", figure.clear()}};
  }
  object["time_ratio"] = number(difference.time_ratio);
  return object;
}

}  // namespace

std::vector<std::pair<std::string, std::string>> headOf(const GatePlan& plan, Cache& cache) {
  const unsigned cores = std::thread::hardware_concurrency();
  const unsigned used = plan.threads > 0 ? static_cast<unsigned>(plan.threads) : cores;
  int bins = 0;
  for (const BinKind& kind : plan.kinds) bins += kind.bins;
  std::vector<std::pair<std::string, std::string>> head = {
      {"date", fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)))},
      {"cpu", processorName()},
      {"cores", fmt::format("{} of {}, load {}", used, cores, loadNow())},
      {"set", fmt::format("{}, seed {}", plan.set.name, plan.set.seed)},
      {"bins",
       fmt::format(
           "{} of {} kinds, each by {} sensors", bins, plan.kinds.size(), plan.sensors.size())}};
  for (const System& system : plan.systems) {
    head.emplace_back(
        system.name, fmt::format("{} ({})", system.program.string(), cache.hashOf(system.program)));
  }
  return head;
}

std::string reportMarkdown(const GateReport& report) {
  std::string text;
  for (const auto& [name, value] : report.head) text += fmt::format("{}: {}  \n", name, value);
  text += "\n### Figures\n\n" + gateMarkdown(report.rows);
  if (!report.differences.empty()) {
    text +=
        "\n### Differences\n\nB - A, with the interval that holds 95 % of 1,000 draws of the bins; "
        "* where it leaves out 0 (of six bins or more). Time: B / A.\n\n" +
        differenceMarkdown(report.differences);
  }
  text += "\n### Calibration\n\nAll checked poses.\n\n" + calibrationMarkdown(report.rows);
  return text;
}

std::string reportJson(const GateReport& report) {
  Json head = Json::object();
  for (const auto& [name, value] : report.head) head[name] = value;
  Json rows = Json::array();
  for (const GateRow& row : report.rows) {
    rows.push_back({{"sensor", row.sensor},
                    {"kind", row.kind},
                    {"part", row.part},
                    {"system", row.system},
                    {"figures", figuresJson(row.figures)}});
  }
  Json differences = Json::array();
  for (const GateDifferenceRow& row : report.differences) {
    differences.push_back(
        {{"sensor", row.sensor}, {"kind", row.kind}, {"figures", differenceJson(row.difference)}});
  }
  const Json all = {{"head", std::move(head)},
                    {"rows", std::move(rows)},
                    {"differences", std::move(differences)}};
  return all.dump(1) + "\n";
}

}  // namespace rangepose::gate
