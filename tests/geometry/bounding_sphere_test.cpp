// The sphere around a part: views show what is in it, and poses that are the same by symmetry are
// compared about its centre.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "core/pose.h"
#include "geometry/mesh.h"
#include "geometry/solids.h"

namespace rangepose {
namespace {

using Points = std::vector<glm::dvec3>;

Mesh meshOf(const Points& points) {
  Mesh mesh;
  for (const glm::dvec3& point : points) mesh.vertices.emplace_back(point);
  return mesh;
}

Points pointsOf(const Mesh& mesh) { return {mesh.vertices.begin(), mesh.vertices.end()}; }

double farthest(const glm::dvec3& center, const Points& points) {
  double most = 0.0;
  for (const glm::dvec3& point : points) most = std::max(most, glm::distance(point, center));
  return most;
}

/// The point as far from all of two to four given ones, in the space that they span: from the
/// normal equations of 2 x . (p_i - p_0) = |p_i - p_0|^2 by Cramer's rule.
bool sameDistance(const Points& on, glm::dvec3& center) {
  const std::size_t n = on.size() - 1;
  glm::dmat3 gram(1.0);
  glm::dvec3 right(0.0);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j)
      gram[static_cast<int>(i)][static_cast<int>(j)] =
          glm::dot(on[i + 1] - on[0], on[j + 1] - on[0]);
    right[static_cast<int>(i)] = 0.5 * gram[static_cast<int>(i)][static_cast<int>(i)];
  }
  const double determinant = glm::determinant(gram);
  if (!(std::abs(determinant) > 1e-14)) return false;
  const glm::dvec3 shares = glm::inverse(gram) * right;
  center = on[0];
  for (std::size_t i = 0; i < n; ++i) center += shares[static_cast<int>(i)] * (on[i + 1] - on[0]);
  return true;
}

/// Of all spheres through two, three or four of the points that hold the others the smallest.
Sphere smallestByTrial(const Points& points) {
  Sphere best{{}, std::numeric_limits<double>::infinity()};
  std::function<void(std::size_t, Points&)> choose = [&](std::size_t from, Points& on) {
    glm::dvec3 center;
    if (on.size() >= 2 && sameDistance(on, center)) {
      const double radius = glm::distance(center, on[0]);
      const bool holds = farthest(center, points) <= radius * (1.0 + 1e-9);
      if (holds && radius < best.radius_mm) best = {center, radius};
    }
    if (on.size() == 4) return;
    for (std::size_t i = from; i < points.size(); ++i) {
      on.push_back(points[i]);
      choose(i + 1, on);
      on.pop_back();
    }
  };
  Points on;
  choose(0, on);
  return best;
}

void expectSmallest(const Points& given) {
  const Mesh mesh = meshOf(given);
  const Points points = pointsOf(mesh);  // as the mesh has rounded them
  const Sphere sphere = boundingSphere(mesh);
  const Sphere expected = smallestByTrial(points);
  EXPECT_LE(farthest(sphere.center_mm, points), sphere.radius_mm) << "views would be cut off";
  EXPECT_NEAR(sphere.radius_mm, expected.radius_mm, 1e-8 * expected.radius_mm);
  EXPECT_LT(glm::distance(sphere.center_mm, expected.center_mm), 1e-5 * expected.radius_mm);
}

class RandomPoints {
 public:
  explicit RandomPoints(unsigned seed) : random_(seed) {}
  double uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(random_()) / 4294967296.0;
  }
  std::size_t count(std::size_t low, std::size_t high) {
    return low + random_() % (high - low + 1);
  }
  glm::dvec3 inBox(const glm::dvec3& size) {
    glm::dvec3 point;
    for (int i = 0; i < 3; ++i) point[i] = uniform(-size[i], size[i]);
    return point;
  }

 private:
  std::mt19937 random_;
};

TEST(BoundingSphereTest, NoSphereThroughVerticesIsSmaller) {
  RandomPoints random(7);
  for (int trial = 0; trial < 400; ++trial) {
    SCOPED_TRACE(trial);
    // Solid, flat, and thin sets, near the origin and far from it.
    const glm::dvec3 size(50.0, trial % 3 == 1 ? 0.01 : 30.0, trial % 4 == 2 ? 0.0 : 20.0);
    const glm::dvec3 offset(trial % 5 == 3 ? 700.0 : 0.0, -20.0, 5.0);
    Points points(random.count(2, 9));
    for (glm::dvec3& point : points) point = offset + random.inBox(size);
    expectSmallest(points);
  }
}

TEST(BoundingSphereTest, VerticesOnOneSphereOrCircleOrLineDoNotConfuse) {
  RandomPoints random(11);
  for (int trial = 0; trial < 200; ++trial) {
    SCOPED_TRACE(trial);
    Points points(random.count(3, 8));
    for (glm::dvec3& point : points) {
      point = glm::normalize(random.inBox(glm::dvec3(1.0)));
      if (trial % 4 == 1) point = {glm::normalize(glm::dvec2(point)), 0.0};
      if (trial % 4 == 2) point = {point.x, 0.0, 0.0};
      point *= 40.0;
    }
    // The same ones again, some of them a little off, as meshes have that were not welded.
    const std::size_t count = points.size();
    for (std::size_t i = 0; i < count && points.size() < 10; ++i) {
      points.push_back(points[i] + random.inBox(glm::dvec3(trial % 2 == 1 ? 1e-4 : 0.0)));
    }
    expectSmallest(points);
  }
}

TEST(BoundingSphereTest, OfOnePointAndOfNone) {
  EXPECT_EQ(boundingSphere(meshOf({{1, 2, 3}, {1, 2, 3}})).radius_mm, 0.0);
  EXPECT_EQ(boundingSphere(meshOf({{1, 2, 3}})).center_mm, glm::dvec3(1, 2, 3));
  EXPECT_EQ(boundingSphere({}).radius_mm, 0.0);
}

/// Ears around an axis away from the origin, and a boss over the middle.
Mesh eared(int ears, bool ends_alike) {
  Mesh mesh;
  const double tip = 0.2;
  std::vector<glm::dvec2> outline;
  for (const glm::dvec2& corner : test::regularPolygon(ears, 36.0, 0.3 - tip)) {
    outline.push_back(corner);
    const double turn = 2.0 * tip;
    outline.emplace_back(std::cos(turn) * corner.x - std::sin(turn) * corner.y,
                         std::sin(turn) * corner.x + std::cos(turn) * corner.y);
  }
  test::addPrism(mesh, outline, 0.0, 6.0);
  if (!ends_alike) test::addPrism(mesh, test::regularPolygon(5 * ears, 8.0, 0.3), 6.0, 70.0);
  return mesh;
}

class SymmetricPartTest : public testing::TestWithParam<int> {};

// The middle of the bounding box of three ears is 13 mm beside their axis.
TEST_P(SymmetricPartTest, CentreLiesOnTheAxis) {
  const Pose somewhere{rotationFromVector({0.4, -1.1, 0.7}), {30.0, -20.0, 70.0}};
  for (const bool ends_alike : {false, true}) {
    const Mesh mesh = test::moved(eared(GetParam(), ends_alike), somewhere);
    const Sphere sphere = boundingSphere(mesh);
    const glm::dvec3 in_part = somewhere.inverse() * sphere.center_mm;
    // Vertices are floats.
    EXPECT_LT(glm::length(glm::dvec2(in_part)), 1e-4);
    EXPECT_TRUE(!ends_alike || std::abs(in_part.z - 3.0) < 1e-4);
    EXPECT_LE(farthest(sphere.center_mm, pointsOf(mesh)), sphere.radius_mm);
  }
}

INSTANTIATE_TEST_SUITE_P(Ears, SymmetricPartTest, testing::Values(2, 3, 5, 6, 7));

TEST(BoundingSphereTest, OfAFineMeshIsThatOfItsShape) {
  // A ball of 500,000 vertices, each within 1e-3 mm of it: a worst case for what searches among
  // points that are about as far out.
  RandomPoints random(3);
  Points points(500000);
  for (glm::dvec3& point : points)
    point = random.uniform(49.999, 50.0) * glm::normalize(random.inBox(glm::dvec3(1.0)));
  const Mesh mesh = meshOf(points);
  const Sphere sphere = boundingSphere(mesh);
  EXPECT_NEAR(sphere.radius_mm, 50.0, 1e-3);
  EXPECT_LT(glm::length(sphere.center_mm), 1e-2);
  EXPECT_LE(farthest(sphere.center_mm, pointsOf(mesh)), sphere.radius_mm);
}

}  // namespace
}  // namespace rangepose
