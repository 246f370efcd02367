#include "eval/pose_errors.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <functional>
#include <limits>

#include "eval/eval_support.h"
#include "support/box_mesh.h"
#include "support/shapes.h"

namespace rangepose {
namespace {

using test::coneMesh;
using test::coneSymmetries;
using test::halfTurns;
using test::randomPose;
using test::turnAbout;

const glm::dvec3 kCenter(5.0, 6.0, 7.0);

Mesh boxMesh() {
  return test::meshOf(
      {{kCenter - glm::dvec3(30.0, 20.0, 10.0), kCenter + glm::dvec3(30.0, 20.0, 10.0)}});
}

Pose shifted(const Pose& pose, const glm::dvec3& shift) {
  Pose result = pose;
  result.translation_mm += shift;
  return result;
}

/// Max and mean distance of the vertices of two poses, straight from the definition.
struct Distances {
  double largest = 0.0;
  double mean = 0.0;
};

Distances distances(const Mesh& mesh, const Pose& a, const Pose& b) {
  Distances result;
  for (const glm::vec3& vertex : mesh.vertices) {
    const double distance = glm::distance(a * glm::dvec3(vertex), b * glm::dvec3(vertex));
    result.largest = std::max(result.largest, distance);
    result.mean += distance / static_cast<double>(mesh.vertices.size());
  }
  return result;
}

/// The smallest of `error` over a dense set of copies of the truth.
double smallest(const Symmetries& symmetries,
                const Pose& truth,
                const std::function<double(const Pose&)>& error) {
  std::vector<Pose> copies{truth};
  for (const Pose& symmetry : symmetries.discrete) copies.push_back(truth * symmetry);
  double best = std::numeric_limits<double>::infinity();
  for (const Pose& copy : copies) {
    best = std::min(best, error(copy));
    constexpr int kSteps = 36000;
    for (int i = 0; i < kSteps && !symmetries.continuous.empty(); ++i) {
      const double angle = 2.0 * std::numbers::pi * i / kSteps;
      best = std::min(best, error(copy * turnAbout(symmetries.continuous.front(), angle)));
    }
  }
  return best;
}

TEST(PoseErrors, TruthAsEstimateIsExactlyZero) {
  std::mt19937_64 random(1);
  const Camera camera = test::pinholeCamera(640, 480, 570.0);
  for (const ErrorModel& model : {ErrorModel(boxMesh(), halfTurns(kCenter)),
                                  ErrorModel(coneMesh(), coneSymmetries()),
                                  ErrorModel(boxMesh(), {})}) {
    const Pose truth = randomPose(random);
    EXPECT_EQ(addErrorMm(model, truth, truth), 0.0);
    EXPECT_EQ(adiErrorMm(model, truth, truth), 0.0);
    EXPECT_EQ(mssdErrorMm(model, truth, truth), 0.0);
    EXPECT_EQ(mspdErrorPx(model, camera, truth, truth), 0.0);
    EXPECT_EQ(vertexErrorMm(model, truth, truth), 0.0);
    EXPECT_EQ(translationErrorMm(model, truth, truth), 0.0);
    EXPECT_LT(rotationErrorRad(model, truth, truth), 1e-14);
  }
}

TEST(PoseErrors, DiscreteCopyIsExactlyZero) {
  std::mt19937_64 random(2);
  const Camera camera = test::pinholeCamera(640, 480, 570.0);
  const Symmetries symmetries = halfTurns(kCenter);
  const ErrorModel model(boxMesh(), symmetries);
  for (const Pose& symmetry : symmetries.discrete) {
    const Pose truth = randomPose(random);
    const Pose copy = truth * symmetry;
    EXPECT_EQ(mssdErrorMm(model, copy, truth), 0.0);
    EXPECT_EQ(mspdErrorPx(model, camera, copy, truth), 0.0);
    EXPECT_EQ(vertexErrorMm(model, copy, truth), 0.0);
    EXPECT_EQ(translationErrorMm(model, copy, truth), 0.0);
    EXPECT_LT(rotationErrorRad(model, copy, truth), 1e-14);
    EXPECT_GT(addErrorMm(model, copy, truth), 10.0) << "ADD is blind to symmetry";
    EXPECT_NEAR(adiErrorMm(model, copy, truth), 0.0, 1e-9) << "vertices fall on vertices";
  }
}

TEST(PoseErrors, AnyTurnOfASolidOfRevolutionIsZero) {
  std::mt19937_64 random(3);
  const Camera camera = test::pinholeCamera(640, 480, 570.0);
  const ErrorModel model(coneMesh(), coneSymmetries());
  for (int i = 0; i < 20; ++i) {
    const Pose truth = randomPose(random);
    const Pose copy = truth * turnAbout(coneSymmetries().continuous.front(), 0.311 * i + 0.1234);
    EXPECT_LT(mssdErrorMm(model, copy, truth), 1e-6);
    EXPECT_LT(mspdErrorPx(model, camera, copy, truth), 1e-6);
    EXPECT_LT(vertexErrorMm(model, copy, truth), 1e-6);
    EXPECT_LT(translationErrorMm(model, copy, truth), 1e-6);
    EXPECT_LT(rotationErrorRad(model, copy, truth), 1e-9);
    EXPECT_LT(glm::length(eulerErrorRad(model, copy, truth)), 1e-6);
  }
}

TEST(PoseErrors, SphereKnowsOnlyItsCentre) {
  std::mt19937_64 random(4);
  const glm::dvec3 center(3.0, -4.0, 5.0);
  Symmetries symmetries;
  symmetries.continuous = {{{0.0, 0.0, 1.0}, center}, {{1.0, 0.0, 0.0}, center}};
  const ErrorModel model(test::sphereMesh(center, 20.0, 8), symmetries);
  const Pose truth = randomPose(random);
  Pose turned;
  turned.rotation = rotationFromVector({0.3, 2.0, -0.7});
  turned.translation_mm = center - turned.rotation * center;
  EXPECT_LT(mssdErrorMm(model, truth * turned, truth), 1e-9);
  EXPECT_NEAR(mssdErrorMm(model, shifted(truth * turned, {0.0, 3.0, 4.0}), truth), 5.0, 1e-9);
  EXPECT_EQ(rotationErrorRad(model, truth * turned, truth), 0.0);
}

TEST(PoseErrors, AgreeWithBruteForceOverDenseCopies) {
  std::mt19937_64 random(5);
  const Camera camera = test::pinholeCamera(640, 480, 570.0);
  struct Case {
    Mesh mesh;
    Symmetries symmetries;
  };
  for (const Case& part :
       {Case{boxMesh(), halfTurns(kCenter)}, Case{coneMesh(), coneSymmetries()}}) {
    const ErrorModel model(part.mesh, part.symmetries);
    // A dense oracle is this much too large at most: half a step of the farthest vertex.
    const double tolerance = part.symmetries.continuous.empty() ? 1e-9 : 0.01;
    for (int i = 0; i < 4; ++i) {
      const Pose truth = randomPose(random);
      const Pose estimate =
          i == 0 ? randomPose(random)
                 : truth * Pose{rotationFromVector({0.1, 0.05 * i, 2.5}), {1.0, 2.0, 3.0 * i}};
      const double mssd = smallest(part.symmetries, truth, [&](const Pose& copy) {
        return distances(part.mesh, estimate, copy).largest;
      });
      const double mean = smallest(part.symmetries, truth, [&](const Pose& copy) {
        return distances(part.mesh, estimate, copy).mean;
      });
      const double mspd = smallest(part.symmetries, truth, [&](const Pose& copy) {
        double largest = 0.0;
        for (const glm::vec3& vertex : part.mesh.vertices) {
          largest = std::max(largest,
                             glm::distance(camera.project(estimate * glm::dvec3(vertex)),
                                           camera.project(copy * glm::dvec3(vertex))));
        }
        return largest;
      });
      const double angle = smallest(part.symmetries, truth, [&](const Pose& copy) {
        return rotationAngleBetween(copy.rotation, estimate.rotation);
      });
      EXPECT_NEAR(mssdErrorMm(model, estimate, truth), mssd, tolerance);
      EXPECT_NEAR(vertexErrorMm(model, estimate, truth), mean, tolerance);
      EXPECT_NEAR(mspdErrorPx(model, camera, estimate, truth), mspd, tolerance);
      EXPECT_NEAR(rotationErrorRad(model, estimate, truth), angle, 2e-4);
      EXPECT_NEAR(
          addErrorMm(model, estimate, truth), distances(part.mesh, estimate, truth).mean, 1e-9);
    }
  }
}

TEST(PoseErrors, ShiftByHand) {
  std::mt19937_64 random(6);
  const ErrorModel model(boxMesh(), halfTurns(kCenter));
  const Pose truth = randomPose(random);
  const Pose estimate = shifted(truth, {0.6, 0.0, -0.8});
  EXPECT_NEAR(addErrorMm(model, estimate, truth), 1.0, 1e-9);
  EXPECT_NEAR(mssdErrorMm(model, estimate, truth), 1.0, 1e-9);
  EXPECT_NEAR(vertexErrorMm(model, estimate, truth), 1.0, 1e-9);
  EXPECT_NEAR(adiErrorMm(model, estimate, truth), 1.0, 1e-9) << "vertices are 20 mm apart";
  EXPECT_NEAR(translationErrorMm(model, estimate, truth), 1.0, 1e-9);
  EXPECT_NEAR(model.diagonalMm(), std::sqrt(60.0 * 60.0 + 40.0 * 40.0 + 20.0 * 20.0), 1e-4);
}

TEST(PoseErrors, MspdByHand) {
  // Moved 1 mm sideways: the nearest vertices, at z = 490, move by 500 / 490 px.
  const Camera camera = test::pinholeCamera(640, 480, 500.0);
  const ErrorModel model(boxMesh(), {});
  Pose truth;
  truth.translation_mm = glm::dvec3(0.0, 0.0, 500.0) - kCenter;
  const Pose estimate = shifted(truth, {1.0, 0.0, 0.0});
  EXPECT_NEAR(mspdErrorPx(model, camera, estimate, truth), 500.0 / 490.0, 1e-6);
  EXPECT_NEAR(mspdErrorPx(model, test::parallelCamera(640, 480, 0.5), estimate, truth), 2.0, 1e-9);
  const Pose behind = shifted(truth, {0.0, 0.0, -495.0});
  EXPECT_EQ(mspdErrorPx(model, camera, behind, truth), std::numeric_limits<double>::infinity());
}

TEST(PoseErrors, LimitsOnlyMakeLargeErrorsInexact) {
  std::mt19937_64 random(7);
  const Camera camera = test::pinholeCamera(640, 480, 570.0);
  const ErrorModel model(coneMesh(), coneSymmetries());
  const double limit = 0.1 * model.diameterMm();
  int below = 0;
  for (int i = 0; i < 200; ++i) {
    const Pose truth = randomPose(random);
    const Pose estimate =
        shifted(truth * turnAbout(coneSymmetries().continuous.front(), i), {0.05 * i, 0.0, 0.0});
    const double exact = mssdErrorMm(model, estimate, truth);
    const double limited = mssdErrorMm(model, estimate, truth, limit);
    EXPECT_TRUE(exact <= limit ? limited == exact : limited > limit) << exact << ' ' << limited;
    below += exact <= limit ? 1 : 0;
    const double exact_px = mspdErrorPx(model, camera, estimate, truth);
    const double limited_px = mspdErrorPx(model, camera, estimate, truth, 5.0);
    EXPECT_TRUE(exact_px <= 5.0 ? limited_px == exact_px : limited_px > 5.0);
  }
  EXPECT_GT(below, 20);
  EXPECT_LT(below, 180);
}

TEST(PoseErrors, EulerAnglesByHand) {
  std::mt19937_64 random(8);
  const ErrorModel model(boxMesh(), halfTurns(kCenter));
  const Pose truth = randomPose(random);
  const glm::dvec3 angles(0.02, -0.05, 0.1);
  glm::dmat3 turn(1.0);
  for (int axis = 0; axis < 3; ++axis) {
    glm::dvec3 vector(0.0);
    vector[axis] = angles[axis];
    turn = rotationFromVector(vector) * turn;
  }
  for (const Pose& symmetry : {Pose{}, halfTurns(kCenter).discrete[1]}) {
    const Pose copy = truth * symmetry;
    const Pose estimate{turn * copy.rotation, copy.translation_mm};
    const glm::dvec3 found = eulerErrorRad(model, estimate, truth);
    for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(found[axis], std::abs(angles[axis]), 1e-9);
  }
}

TEST(PoseErrors, BrokenMeshIsRefused) { EXPECT_THROW(ErrorModel(Mesh{}, {}), Error); }

TEST(PointTree, FindsWhatBruteForceFinds) {
  std::mt19937_64 random(9);
  std::vector<glm::dvec3> points;
  points.reserve(501);
  for (int i = 0; i < 500; ++i) points.push_back(randomPose(random).translation_mm);
  points.push_back(points.front());  // a double one
  const PointTree tree(points);
  for (int i = 0; i < 500; ++i) {
    const glm::dvec3 query = randomPose(random, 150.0).translation_mm;
    const glm::dvec3 found = points[tree.nearest(query)];
    double best = std::numeric_limits<double>::infinity();
    for (const glm::dvec3& point : points) best = std::min(best, glm::distance(point, query));
    EXPECT_EQ(glm::distance(found, query), best);
  }
  EXPECT_THROW(PointTree({}), Error);
}

}  // namespace
}  // namespace rangepose
