#include "sampling/view_symmetry.h"

#include <gtest/gtest.h>

#include <cmath>

#include "geometry/orientation_grid.h"
#include "sampling/groups.h"

namespace rangepose {
namespace {

using test::anyTurn;
using test::finite;
using test::revolution;

TEST(ViewSymmetryTest, FoldedLooksTheSame) {
  const std::vector<Symmetries> all = {finite(octahedralGroup(), anyTurn()),
                                       revolution({1.0, 2.0, -0.5}, false),
                                       revolution({1.0, 2.0, -0.5}, true),
                                       {}};
  for (const Symmetries& symmetries : all) {
    const ViewSymmetry symmetry(symmetries);
    for (const glm::dmat3& rotation : uniformRotations(200)) {
      const glm::dmat3 folded = symmetry.folded(rotation);
      EXPECT_NEAR(glm::determinant(folded), 1.0, 1e-9);
      EXPECT_LT(rotationAngleModulo(symmetries, rotation, folded), 1e-6);
    }
  }
}

TEST(ViewSymmetryTest, DirectionsOfARevolutionFallOntoOneMeridian) {
  for (const bool ends_alike : {false, true}) {
    const glm::dvec3 axis = glm::normalize(glm::dvec3(1.0, 2.0, -0.5));
    const ViewSymmetry symmetry(revolution(axis, ends_alike));
    glm::dvec3 side(0.0);
    for (const glm::dmat3& rotation : uniformRotations(200)) {
      const glm::dvec3 direction = viewDirection(symmetry.folded(rotation));
      const double along = glm::dot(direction, axis);
      const double before = glm::dot(viewDirection(rotation), axis);
      EXPECT_NEAR(along, ends_alike ? std::abs(before) : before, 1e-9);
      const glm::dvec3 across = glm::normalize(direction - along * axis);
      if (glm::length(side) == 0.0) side = across;
      EXPECT_LT(glm::distance(across, side), 1e-6);
    }
  }
}

TEST(ViewSymmetryTest, ImagesOfADirectionBelongToTheSamePicture) {
  const Symmetries symmetries = finite(tetrahedralGroup(), anyTurn());
  const ViewSymmetry symmetry(symmetries);
  ASSERT_EQ(symmetry.elements().size(), 12u);
  const glm::dmat3 rotation = rotationFromVector({0.2, -2.0, 0.7});
  for (const glm::dmat3& element : symmetry.elements()) {
    const glm::dmat3 image = rotation * glm::transpose(element);
    EXPECT_LT(glm::distance(viewDirection(image), element * viewDirection(rotation)), 1e-12);
    EXPECT_LT(rotationAngleModulo(symmetries, rotation, image), 1e-6);
  }
}

TEST(ViewSymmetryTest, CountsInPlaneCopies) {
  const ViewSymmetry bolt(finite(cyclicGroup(6), anyTurn()));
  const glm::dvec3 axis = anyTurn()[2];
  EXPECT_EQ(bolt.inPlaneCopies(axis, 0.01), 6);
  EXPECT_EQ(bolt.inPlaneCopies(-axis, 0.01), 6);
  EXPECT_EQ(bolt.inPlaneCopies(anyTurn()[0], 0.1), 1);
  const ViewSymmetry prism(finite(dihedralGroup(6), anyTurn()));
  EXPECT_EQ(prism.inPlaneCopies(axis, 0.01), 6);
  EXPECT_EQ(prism.inPlaneCopies(anyTurn()[0], 0.01), 2);
  const ViewSymmetry rod(revolution(axis, true));
  EXPECT_EQ(rod.inPlaneCopies(anyTurn()[0], 0.1), 2);
  EXPECT_EQ(rod.inPlaneCopies(glm::normalize(axis + anyTurn()[0]), 0.1), 1);
}

TEST(ViewSymmetryTest, InPlaneTurnsOfARodSeenAlongItDoNotShow) {
  const ViewSymmetry rod(revolution({0.0, 0.0, 1.0}, true));
  EXPECT_NEAR(rod.inPlaneEffect({0.0, 0.0, 1.0}), 0.0, 1e-12);
  EXPECT_NEAR(rod.inPlaneEffect({0.0, 1.0, 0.0}), 1.0, 1e-12);
  EXPECT_NEAR(rod.inPlaneEffect({0.0, 0.6, 0.8}), 0.6, 1e-12);
  EXPECT_EQ(ViewSymmetry({}).inPlaneEffect({0.0, 0.0, 1.0}), 1.0);
}

TEST(ShortestTurnTest, TurnsOneIntoTheOther) {
  const std::vector<glm::dmat3> rotations = uniformRotations(60);
  for (std::size_t i = 0; i + 1 < rotations.size(); i += 2) {
    const glm::dvec3 from = rotations[i][0];
    const glm::dvec3 to = rotations[i + 1][1];
    const glm::dmat3 turn = shortestTurn(from, to);
    EXPECT_LT(glm::distance(turn * from, to), 1e-9);
    EXPECT_NEAR(rotationAngleBetween(turn, glm::dmat3(1.0)), std::acos(glm::dot(from, to)), 1e-7);
  }
  const glm::dvec3 up(0.0, 0.0, 1.0);
  EXPECT_LT(glm::distance(shortestTurn(up, -up) * up, -up), 1e-9);
  EXPECT_EQ(shortestTurn(up, up), glm::dmat3(1.0));
}

}  // namespace
}  // namespace rangepose
