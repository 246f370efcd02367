// A camera near to a part sees it from aside, and more of its near end: references are seen by
// parallel rays. Parts must be found whatever the distance and wherever in the image they are.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "pipeline/estimate.h"
#include "sim/random.h"
#include "sim/scanner.h"
#include "support/model_parts.h"
#include "support/part_symmetries.h"

namespace rangepose {
namespace {

constexpr int kWidth = 640;
constexpr int kHeight = 480;
/// A part is this share of the image wide, whatever its distance.
constexpr double kShare = 0.2;
constexpr double kRight = 0.02;

constexpr std::uint64_t kSeeds = 2;
/// Where the centre of the part is seen.
constexpr glm::dvec2 kMiddle(320.0, 240.0);
constexpr glm::dvec2 kCorner(560.0, 90.0);

/// Truth and image of a part that floats over a table, `diameters` away from the camera.
struct View {
  DepthImage image;
  Pose truth;
};

View viewOf(const ReferenceObject& object,
            double diameters,
            const glm::dvec2& pixel,
            std::uint64_t seed) {
  Random random(seed);
  const double distance_mm = diameters * object.diameter_mm;
  ScannerOptions options;
  options.width = kWidth;
  options.height = kHeight;
  options.focal_px = kShare * kWidth * diameters;
  options.seed = seed;
  const Camera camera = scannerCamera(options);
  const glm::dvec3 ray = camera.unproject(pixel.x, pixel.y, 1.0);
  const glm::dvec3 center = glm::normalize(ray) * distance_mm;
  View view;
  view.truth.rotation = random.rotation();
  view.truth.translation_mm = center - view.truth.rotation * object.center_mm;
  // Straight down on a table that the part nearly touches.
  const double table_mm = center.z + 1.2 * object.radius_mm;
  const Pose camera_from_world{rotationFromVector({std::acos(-1.0), 0.0, 0.0}),
                               {0.0, 0.0, table_mm}};
  PlacedPart part;
  part.world_from_object = camera_from_world.inverse() * view.truth;
  view.image = scanFrom({object.mesh}, {part}, camera_from_world, options).image;
  return view;
}

class PerspectiveTest : public testing::TestWithParam<double> {};

/// Vertex error of the best pose as a share of the diameter; 1 where there is no pose.
double errorShare(const ReferenceDatabase& database,
                  const std::vector<Pose>& symmetries,
                  const View& view) {
  const std::unique_ptr<StageSet> stages = makeHostStages();
  const Estimate estimate = estimatePoses(view.image, std::nullopt, database, {}, *stages);
  if (estimate.poses.empty()) return 1.0;
  const ReferenceObject& object = database.objects.front();
  return test::vertexError(object.mesh, symmetries, estimate.poses.front().pose, view.truth) /
         object.diameter_mm;
}

TEST_P(PerspectiveTest, PartsAreFoundInTheMiddleAndNearACornerOfTheImage) {
  int trials = 0;
  int right = 0;
  double error_sum = 0.0;
  for (const std::string part : {"t_pipe", "bolt", "elbow", "bracket"}) {
    const ReferenceDatabase database = test::databaseOfMeshes({test::modelMesh(part)});
    const ReferenceObject& object = database.objects.front();
    const std::vector<Pose> symmetries = test::symmetriesOf(part, object.mesh);
    for (const glm::dvec2& pixel : {kMiddle, kCorner}) {
      for (std::uint64_t seed = 30000; seed < 30000 + kSeeds; ++seed, ++trials) {
        const double error =
            errorShare(database, symmetries, viewOf(object, GetParam(), pixel, seed));
        if (error < kRight) {
          ++right;
          error_sum += error;
        } else {
          std::printf("  wrong: %s, seed %d, %.3f\n", part.c_str(), static_cast<int>(seed), error);
        }
      }
    }
  }
  std::printf("  %2.0f diameters away: %d of %d right, mean error %.3f %%\n",
              GetParam(),
              right,
              trials,
              100.0 * error_sum / std::max(right, 1));
  EXPECT_GE(right, trials - 1) << "one view may not tell: a branch that lies behind its pipe";
  EXPECT_LT(error_sum, 0.003 * right);
}

INSTANTIATE_TEST_SUITE_P(DiametersAway,
                         PerspectiveTest,
                         testing::Values(3.0, 6.0, 12.0),
                         [](const auto& distance) {
                           return std::to_string(static_cast<int>(distance.param));
                         });

}  // namespace
}  // namespace rangepose
