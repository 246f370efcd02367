#include "sim/depth_oracle.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "io/mesh_file.h"
#include "sim/physics_part.h"
#include "sim/sim_meshes.h"

namespace rangepose {
namespace {

TEST(DepthOracleTest, KnowsTheDepthInABoxAndInAHollowPart) {
  const test::DepthOracle box(boxMesh({-10, -20, -30}, {10, 20, 30}));
  EXPECT_NEAR(box.depth({7, 1, 2}), 3.0, 1e-9);
  EXPECT_NEAR(box.depth({1, -19.5, 2}), 0.5, 1e-9);
  EXPECT_EQ(box.depth({10.5, 0, 0}), 0.0);
  // The bore of a pipe is outside, its wall inside.
  const Mesh mesh =
      readMesh(std::filesystem::path(RP_MODELS_DIR) / "elbow.ply", LengthUnit::kMillimetre);
  const test::DepthOracle elbow(mesh);
  Random random(3);
  int inside = 0;
  const Sphere sphere = boundingSphere(mesh);
  constexpr int kPoints = 40000;
  for (int k = 0; k < kPoints; ++k) {
    glm::dvec3 p;
    for (int i = 0; i < 3; ++i) p[i] = random.uniform(-sphere.radius_mm, sphere.radius_mm);
    inside += elbow.isInside(sphere.center_mm + p) ? 1 : 0;
  }
  const double volume = std::pow(2.0 * sphere.radius_mm, 3) * inside / kPoints;
  EXPECT_NEAR(volume, solidMass(mesh).volume_mm3, 0.06 * volume);
}

}  // namespace
}  // namespace rangepose
