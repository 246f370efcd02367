#include "pipeline/picking.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.h"
#include "pipeline/freedom.h"

namespace rangepose {
namespace {

/// Score times freedom is told apart in steps of this: scores are not surer than that.
constexpr double kStep = 0.1;

/// Where positions and heights are told, as the camera sees it.
struct CellFrame {
  Pose camera_from_cell;
  glm::dvec3 up{0.0};  ///< camera frame

  explicit CellFrame(const std::optional<BinBox>& bin)
      : camera_from_cell(bin ? bin->camera_from_bin : Pose{}),
        up(bin ? bin->camera_from_bin.rotation[2] : glm::dvec3(0.0, 0.0, -1.0)) {}
};

/// Unit vectors in the camera frame along which the tool may move, the one straight down first.
std::vector<glm::dvec3> approaches(const CellFrame& cell, double cone_rad) {
  std::vector<glm::dvec3> directions = {-cell.up};
  if (cone_rad <= 0.0) return directions;
  const glm::dvec3 x = cell.camera_from_cell.rotation[0];
  const glm::dvec3 y = cell.camera_from_cell.rotation[1];
  for (const int ring : {1, 2}) {
    const double lean = 0.5 * ring * cone_rad;
    const int count = 6 * ring;
    for (int k = 0; k < count; ++k) {
      const double turn = 2.0 * std::numbers::pi * k / count;
      const glm::dvec3 aside = std::cos(turn) * x + std::sin(turn) * y;
      directions.push_back(std::sin(lean) * aside - std::cos(lean) * cell.up);
    }
  }
  return directions;
}

bool inside(const glm::dvec3& position, const Workspace& box) {
  return glm::all(glm::greaterThanEqual(position, box.low_mm)) &&
         glm::all(glm::lessThanEqual(position, box.high_mm));
}

bool canBePicked(const Pick& pick, const PickOptions& options) {
  if (options.workspace && !inside(pick.position_mm, *options.workspace)) return false;
  return pick.freedom >= options.min_freedom;
}

/// Position and height of each pose, and along which approach it is most free.
std::vector<Pick> allPicks(const std::vector<PoseEstimate>& poses,
                           const FoundScene& scene,
                           const CellFrame& cell,
                           const ReferenceDatabase& database,
                           double cone_rad) {
  const Pose cell_from_camera = cell.camera_from_cell.inverse();
  std::vector<Pick> picks(poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const auto object = static_cast<std::size_t>(poses[i].object);
    const glm::dvec3 center = poses[i].pose * database.objects.at(object).center_mm;
    picks[i].pose = i;
    picks[i].freedom = -1.0;
    picks[i].position_mm = cell_from_camera * center;
    picks[i].height_mm = glm::dot(cell.up, center - cell.camera_from_cell.translation_mm);
  }
  for (const glm::dvec3& approach : approaches(cell, cone_rad)) {
    const std::vector<double> freedom = scene.freedom(approach);
    for (std::size_t i = 0; i < picks.size(); ++i) {
      if (freedom[i] <= picks[i].freedom) continue;
      picks[i].freedom = freedom[i];
      picks[i].approach = approach;
    }
  }
  return picks;
}

}  // namespace

void PickOptions::check() const {
  RP_CHECK(cone_rad >= 0.0 && cone_rad < 1.4, "cone_rad must lie in 0..1.4");
  RP_CHECK(min_freedom >= 0.0 && min_freedom <= 1.0, "min_freedom must lie in 0..1");
  RP_CHECK(max_picks >= 0, "max_picks must not be negative");
  RP_CHECK(!workspace || glm::all(glm::lessThan(workspace->low_mm, workspace->high_mm)),
           "workspace must have low_mm below high_mm along each axis");
  RP_CHECK(!arm_mm || std::isfinite(glm::length(*arm_mm)), "arm_mm must be finite");
}

std::vector<Pick> pickingOrder(const std::vector<PoseEstimate>& poses,
                               const DepthImage& depth,
                               double noise_mm,
                               const std::optional<BinBox>& bin,
                               const ReferenceDatabase& database,
                               const PickOptions& options) {
  options.check();
  const CellFrame cell(bin);
  const FoundScene scene(poses, depth, noise_mm, database);
  std::vector<Pick> picks = allPicks(poses, scene, cell, database, options.cone_rad);
  std::erase_if(picks, [&](const Pick& pick) { return !canBePicked(pick, options); });
  const auto most = static_cast<std::size_t>(options.max_picks);
  if (most > 0 && picks.size() > most) picks.resize(most);
  // The 1e-9 keeps 0.9 times 1 in the step that begins there.
  const auto step = [&](const Pick& pick) {
    return std::floor(poses[pick.pose].confidence * pick.freedom / kStep + 1e-9);
  };
  const auto near = [&](const Pick& pick) {
    return options.arm_mm ? -glm::distance(pick.position_mm, *options.arm_mm) : pick.height_mm;
  };
  std::stable_sort(picks.begin(), picks.end(), [&](const Pick& a, const Pick& b) {
    return step(a) != step(b) ? step(a) > step(b) : near(a) > near(b);
  });
  return picks;
}

}  // namespace rangepose
