#include "rangepose/picking_options.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <utility>

#include "rangepose/command.h"
#include "rangepose/scene_input.h"

namespace rangepose::cli {
namespace {

constexpr double kWidestConeDeg = 80.0;

void checkFinite(const std::vector<double>& values, const char* option) {
  for (const double value : values) {
    if (!std::isfinite(value)) {
      throw UsageError(
          fmt::format("{}: {} is no finite number; give lengths in mm", option, value));
    }
  }
}

Workspace boxOf(const std::vector<double>& limits) {
  checkFinite(limits, "--workspace");
  Workspace box;
  for (int axis = 0; axis < 3; ++axis) {
    const double low = limits.at(2 * static_cast<std::size_t>(axis));
    const double high = limits.at(2 * static_cast<std::size_t>(axis) + 1);
    if (!(low < high)) {
      const char name = "XYZ"[axis];
      throw UsageError(
          fmt::format("--workspace: {0}0 {1:g} is not below {0}1 {2:g}; give X0 X1 Y0 "
                      "Y1 Z0 Z1",
                      name,
                      low,
                      high));
    }
    box.low_mm[axis] = low;
    box.high_mm[axis] = high;
  }
  return box;
}

}  // namespace

void declarePicking(CLI::App& command, PickingArguments& arguments) {
  command
      .add_option("--approach-cone",
                  arguments.approach_cone_deg,
                  "The tool may lean this far from straight down [deg]: a part is as free as along "
                  "the best direction in that cone")
      ->option_text("DEG [0]");
  command
      .add_option("--min-freedom",
                  arguments.min_freedom,
                  "Leave out parts of which less lies free to the tool")
      ->check(shareValidator())
      ->capture_default_str();
  command
      .add_option("--workspace",
                  arguments.workspace,
                  "Leave out parts whose centre lies outside [mm]; frame of the bin, without --bin "
                  "of the camera")
      ->expected(6)
      ->option_text("X0 X1 Y0 Y1 Z0 Z1");
  command
      .add_option("--arm",
                  arguments.arm,
                  "Where the arm comes from [mm], frame as for --workspace: of parts about as good "
                  "the nearest is first, not the highest")
      ->expected(3)
      ->option_text("X Y Z");
}

PickOptions pickingOptions(const PickingArguments& arguments) {
  PickOptions options;
  const double cone_deg = arguments.approach_cone_deg;
  if (!(cone_deg >= 0.0 && cone_deg < kWidestConeDeg)) {
    throw UsageError(fmt::format(
        "--approach-cone: {:g} is not from 0 to below {:g} degrees", cone_deg, kWidestConeDeg));
  }
  options.cone_rad = cone_deg * std::numbers::pi / 180.0;
  options.min_freedom = arguments.min_freedom;
  if (!arguments.workspace.empty()) options.workspace = boxOf(arguments.workspace);
  if (!arguments.arm.empty()) {
    checkFinite(arguments.arm, "--arm");
    options.arm_mm = {arguments.arm.at(0), arguments.arm.at(1), arguments.arm.at(2)};
  }
  return options;
}

void keepPicks(Estimate& estimate, const std::vector<Pick>& picks) {
  std::vector<PoseEstimate> kept;
  for (const Pick& pick : picks) kept.push_back(estimate.poses.at(pick.pose));
  estimate.poses = std::move(kept);
}

}  // namespace rangepose::cli
