// Partners of points in a depth image: against a search in doubles, and eight at a time against one
// at a time, which is what a GPU computes. Where these differ, paths answer differently.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "core/image.h"
#include "stages/icp_points_core.h"
#include "support/range_scenes.h"

namespace rangepose {
namespace {

using test::Random;

/// A bumpy wall with holes and nearer pieces.
struct Wall {
  explicit Wall(bool orthographic) : depth_mm(120, 90) {
    camera.width = depth_mm.width();
    camera.height = depth_mm.height();
    camera.fx = 300.0;
    camera.fy = 290.0;
    camera.cx = 61.3;
    camera.cy = 44.2;
    camera.orthographic = orthographic;
    camera.pixel_size_mm = 1.5;
    Random random(3);
    for (float& mm : depth_mm) {
      const int kind = random.index(10);
      mm = kind == 0 ? 0.0f : static_cast<float>(random.uniform(kind == 1 ? 330.0 : 396.0, 404.0));
    }
  }

  /// Near the wall, some of them beside the image.
  glm::dvec3 pointNear(Random& random) const {
    const double u = random.uniform(-8.0, camera.width + 8.0);
    const double v = random.uniform(-8.0, camera.height + 8.0);
    return camera.unproject(u, v, random.uniform(380.0, 420.0));
  }

  IcpView view(double reach_mm, int steps) const {
    IcpOptions options;
    options.search_steps = steps;
    options.rim_reach_mm = 9.0;
    options.rim_steps = 5;
    return icpView(firstFrame({}, {}, 40.0, withReach(options, reach_mm)), options, camera);
  }
  static IcpOptions withReach(IcpOptions options, double reach_mm) {
    options.first_reach_mm = reach_mm;
    return options;
  }

  // As the reader of the formulas.
  float operator()(bool where, int u, int v) const { return where ? depth_mm.at(u, v) : 0.0f; }
  Float8 operator()(const Int8& where, const Int8& u, const Int8& v) const {
    Float8 values{};
    for (int i = 0; i < kLanes; ++i) {
      if (where[i] != 0) values[i] = depth_mm.at(u[i], v[i]);
    }
    return values;
  }

  Camera camera;
  Image<float> depth_mm;
};

/// The squared distance to the nearest measured point of the grid, as the contract says it.
std::optional<double> bruteForce(const Wall& wall,
                                 const glm::dvec3& point,
                                 double reach_mm,
                                 int steps) {
  const glm::dvec2 pixel = wall.camera.project(point);
  const int u = static_cast<int>(std::floor(pixel.x + 0.5));
  const int v = static_cast<int>(std::floor(pixel.y + 0.5));
  const auto inside = [&](int x, int y) {
    return x >= 0 && y >= 0 && x < wall.camera.width && y < wall.camera.height;
  };
  if (!inside(u, v)) return std::nullopt;
  const double here = static_cast<double>(wall.depth_mm.at(u, v));
  if (here != 0.0 && here < point.z - reach_mm) return std::nullopt;
  const double pixel_mm = wall.camera.pixelSpacingMm(point.z);
  const int spacing = std::max(1, static_cast<int>(reach_mm / pixel_mm / steps));
  double best = reach_mm * reach_mm;
  for (int dv = -steps; dv <= steps; ++dv) {
    for (int du = -steps; du <= steps; ++du) {
      const int x = u + du * spacing;
      const int y = v + dv * spacing;
      if (!inside(x, y) || wall.depth_mm.at(x, y) == 0.0f) continue;
      const double depth = static_cast<double>(wall.depth_mm.at(x, y));
      const glm::dvec3 gap = wall.camera.unproject(x, y, depth) - point;
      best = std::min(best, glm::dot(gap, gap));
    }
  }
  return best < reach_mm * reach_mm ? std::optional(best) : std::nullopt;
}

class IcpPointsTest : public testing::TestWithParam<bool> {};

TEST_P(IcpPointsTest, PartnersAreTheNearestOfTheGrid) {
  const Wall wall(GetParam());
  Random random(5);
  int found = 0;
  int none = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    const double reach_mm = random.uniform(2.0, 25.0);
    const int steps = 1 + random.index(3);
    const glm::dvec3 point = wall.pointNear(random);
    const Lane3<float> at{
        static_cast<float>(point.x), static_cast<float>(point.y), static_cast<float>(point.z)};
    const IcpView view = wall.view(reach_mm, steps);
    const IcpPartner<float> partner = icpPartner(view, wall, true, at);
    const std::optional<double> expected = bruteForce(wall, point, reach_mm, steps);
    const bool has = partner.squared_mm2 < view.reach_mm * view.reach_mm;
    ASSERT_EQ(has, expected.has_value()) << "trial " << trial;
    (has ? found : none) += 1;
    if (!has) continue;
    // An early end may leave a point that is nearer by the slant of a ray.
    EXPECT_NEAR(std::sqrt(partner.squared_mm2), std::sqrt(*expected), 0.05) << "trial " << trial;
    EXPECT_FALSE(icpPartner(view, wall, false, at).squared_mm2 < view.reach_mm * view.reach_mm);
  }
  EXPECT_GT(found, 300);
  EXPECT_GT(none, 300);
}

/// Eight points with unit directions; some that no image holds.
struct EightPoints {
  EightPoints(const Wall& wall, Random& random) {
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    for (int i = 0; i < kLanes; ++i) {
      const glm::dvec3 point = wall.pointNear(random);
      const glm::dvec3 out = glm::normalize(glm::dvec3(
          random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), random.uniform(-0.5, 0.5)));
      const int kind = random.index(12);
      at.x[i] = kind == 0 ? kNan : static_cast<float>(point.x);
      at.y[i] = static_cast<float>(point.y);
      at.z[i] = static_cast<float>(kind == 1 ? -point.z : kind == 2 ? 0.0 : point.z);
      direction.x[i] = static_cast<float>(out.x);
      direction.y[i] = static_cast<float>(out.y);
      direction.z[i] = static_cast<float>(out.z);
      wanted[i] = random.index(8) == 0 ? 0 : -1;
    }
  }
  static Lane3<float> lane(const Lane3<Float8>& eight, int i) {
    return {eight.x[i], eight.y[i], eight.z[i]};
  }

  Int8 wanted{};
  Lane3<Float8> at{};
  Lane3<Float8> direction{};
};

TEST_P(IcpPointsTest, EightPartnersAreThoseOfEachPoint) {
  const Wall wall(GetParam());
  Random random(6);
  for (int trial = 0; trial < 300; ++trial) {
    const IcpView view = wall.view(random.uniform(2.0, 25.0), 1 + random.index(2));
    const EightPoints points(wall, random);
    const IcpPartner<Float8> all = icpPartner(view, wall, points.wanted, points.at);
    for (int i = 0; i < kLanes; ++i) {
      const Lane3<float> at = EightPoints::lane(points.at, i);
      const IcpPartner<float> own = icpPartner(view, wall, points.wanted[i] != 0, at);
      ASSERT_EQ(own.squared_mm2, all.squared_mm2[i]) << "trial " << trial << ", lane " << i;
      if (!(own.squared_mm2 < view.reach_mm * view.reach_mm)) continue;
      EXPECT_EQ(own.point_mm.x, all.point_mm.x[i]);
      EXPECT_EQ(own.point_mm.y, all.point_mm.y[i]);
      EXPECT_EQ(own.point_mm.z, all.point_mm.z[i]);
    }
  }
}

TEST_P(IcpPointsTest, EightRimsAreThoseOfEachPoint) {
  const Wall wall(GetParam());
  Random random(7);
  int found = 0;
  for (int trial = 0; trial < 400; ++trial) {
    const IcpView view = wall.view(random.uniform(2.0, 25.0), 1);
    const EightPoints points(wall, random);
    const Lane3<Float8>& out = points.direction;
    const Float8 across = squareRoot(out.x * out.x + out.y * out.y);
    const RimPartner<Float8> all = rimPartner(view, wall, points.wanted, points.at, out, across);
    for (int i = 0; i < kLanes; ++i) {
      const RimPartner<float> own = rimPartner(view,
                                               wall,
                                               points.wanted[i] != 0,
                                               EightPoints::lane(points.at, i),
                                               EightPoints::lane(out, i),
                                               across[i]);
      ASSERT_EQ(own.found, all.found[i] != 0) << "trial " << trial << ", lane " << i;
      ASSERT_EQ(own.beyond_mm, all.beyond_mm[i]) << "trial " << trial << ", lane " << i;
      found += own.found ? 1 : 0;
    }
  }
  EXPECT_GT(found, 300);
}

INSTANTIATE_TEST_SUITE_P(PinholeAndOrthographic, IcpPointsTest, testing::Bool());

}  // namespace
}  // namespace rangepose
