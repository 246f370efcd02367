#include "eval/paper_figures.h"

#include <array>
#include <cstddef>
#include <string_view>

namespace rangepose {
namespace {

// Rows of all tables: the three models and their average or sum.
constexpr std::array<std::string_view, 4> kModels = {"t_pipe", "bolt", "elbow", "all"};

std::optional<std::size_t> rowOf(const std::string& model) {
  for (std::size_t i = 0; i < kModels.size(); ++i) {
    if (kModels[i] == model) return i;
  }
  return std::nullopt;
}

/// Columns of Tables 4 and 5: 1024 at 32 px, 1024 at 64 px, 2048 at 32 px, 2048 at 64 px.
std::optional<std::size_t> columnOf(const PaperSetting& setting) {
  if ((setting.size != 32 && setting.size != 64) ||
      (setting.views != 1024 && setting.views != 2048)) {
    return std::nullopt;
  }
  return (setting.views == 2048 ? 2U : 0U) + (setting.size == 64 ? 1U : 0U);
}

struct RoughCell {
  int correct;
  double vertex;
  double euler[3];
};

struct FineCell {
  double vertex;
  double euler[3];
};

// Columns as in columnOf().
constexpr RoughCell kUniform[4][2] = {
    {{48, 6.78, {7.75, 6.91, 5.55}}, {49, 6.18, {8.60, 6.27, 5.40}}},
    {{88, 6.73, {7.10, 6.70, 6.44}}, {89, 4.98, {6.42, 5.43, 5.42}}},
    {{38, 5.67, {7.40, 8.10, 5.75}}, {44, 5.23, {10.72, 6.75, 4.64}}},
    {{174, 6.44, {7.37, 7.16, 5.99}}, {182, 5.40, {8.27, 6.05, 5.19}}}};

constexpr RoughCell kAdaptive[4][4] = {{{52, 5.24, {5.58, 4.87, 3.46}},
                                        {56, 5.11, {6.56, 5.73, 3.06}},
                                        {57, 5.24, {5.67, 5.73, 2.89}},
                                        {57, 4.74, {5.66, 5.69, 2.59}}},
                                       {{89, 5.99, {6.41, 5.92, 6.94}},
                                        {90, 4.59, {6.04, 4.81, 4.67}},
                                        {89, 6.37, {9.17, 6.94, 6.47}},
                                        {90, 0.05, {3.70, 4.27, 6.06}}},
                                       {{55, 4.55, {5.60, 5.03, 4.99}},
                                        {57, 5.03, {5.87, 5.97, 5.26}},
                                        {54, 4.63, {6.68, 5.17, 4.70}},
                                        {55, 3.63, {5.14, 4.97, 4.42}}},
                                       {{196, 5.26, {5.86, 5.27, 5.13}},
                                        {203, 4.91, {6.16, 5.50, 4.33}},
                                        {200, 5.41, {7.17, 5.95, 4.69}},
                                        {202, 2.81, {4.83, 4.98, 4.36}}}};

constexpr FineCell kFine[4][4] = {{{0.62, {0.20, 0.52, 0.28}},
                                   {0.58, {0.61, 0.66, 0.26}},
                                   {0.70, {0.43, 0.35, 0.30}},
                                   {0.18, {0.05, 0.06, 0.04}}},
                                  {{2.48, {1.58, 1.56, 4.06}},
                                   {1.28, {0.27, 0.35, 1.48}},
                                   {2.26, {2.17, 1.93, 3.05}},
                                   {0.01, {0.29, 0.32, 1.89}}},
                                  {{0.35, {0.11, 0.12, 0.11}},
                                   {0.18, {0.04, 0.04, 0.04}},
                                   {0.32, {0.12, 0.12, 0.14}},
                                   {0.14, {0.04, 0.03, 0.03}}},
                                  {{1.15, {0.63, 0.73, 1.48}},
                                   {0.68, {0.31, 0.35, 0.59}},
                                   {1.09, {0.91, 0.80, 1.16}},
                                   {0.11, {0.13, 0.14, 0.65}}}};

constexpr double kMemoryMb[3][4] = {
    {25.61, 73.22, 47.00, 142.17}, {20.40, 50.13, 36.41, 95.74}, {27.79, 82.15, 51.48, 160.80}};

constexpr double kRoughSeconds[4][4] = {{0.33, 0.46, 0.65, 0.95},
                                        {0.26, 0.32, 0.50, 0.63},
                                        {0.37, 0.51, 0.72, 1.02},
                                        {0.32, 0.43, 0.62, 0.87}};

constexpr double kFineSeconds[4][4] = {{0.01, 0.02, 0.01, 0.02},
                                       {0.01, 0.02, 0.01, 0.02},
                                       {0.02, 0.02, 0.02, 0.02},
                                       {0.01, 0.02, 0.01, 0.02}};

glm::dvec3 vectorOf(const double (&values)[3]) { return {values[0], values[1], values[2]}; }

}  // namespace

std::optional<PaperRough> paperRough(const PaperSetting& setting, const std::string& model) {
  const std::optional<std::size_t> row = rowOf(model);
  const std::optional<std::size_t> column = columnOf(setting);
  if (!row || !column) return std::nullopt;
  const bool uniform = setting.sampling == "uniform";
  if (uniform && *column > 1) return std::nullopt;
  const RoughCell& cell = uniform ? kUniform[*row][*column] : kAdaptive[*row][*column];
  return PaperRough{cell.correct, {cell.vertex, vectorOf(cell.euler)}};
}

std::optional<PaperErrors> paperFine(const PaperSetting& setting, const std::string& model) {
  const std::optional<std::size_t> row = rowOf(model);
  const std::optional<std::size_t> column = columnOf(setting);
  if (!row || !column || setting.sampling != "adaptive") return std::nullopt;
  const FineCell& cell = kFine[*row][*column];
  return PaperErrors{cell.vertex, vectorOf(cell.euler)};
}

std::optional<double> paperMemoryMb(const PaperSetting& setting, const std::string& model) {
  const std::optional<std::size_t> row = rowOf(model);
  const std::optional<std::size_t> column = columnOf(setting);
  if (!row || !column || *row > 2) return std::nullopt;
  return kMemoryMb[*row][*column];
}

std::optional<double> paperRoughSeconds(const PaperSetting& setting, const std::string& model) {
  const std::optional<std::size_t> row = rowOf(model);
  const std::optional<std::size_t> column = columnOf(setting);
  if (!row || !column) return std::nullopt;
  return kRoughSeconds[*row][*column];
}

std::optional<double> paperFineSeconds(const PaperSetting& setting, const std::string& model) {
  const std::optional<std::size_t> row = rowOf(model);
  const std::optional<std::size_t> column = columnOf(setting);
  if (!row || !column) return std::nullopt;
  return kFineSeconds[*row][*column];
}

}  // namespace rangepose
