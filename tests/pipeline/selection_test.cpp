// Surface that a pose explains belongs to it: shared by two poses, one part is picked twice; taken
// too eagerly, the part beside it is missed.
#include "pipeline/selection.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "database/reference_database.h"
#include "geometry/orientation_grid.h"
#include "pipeline/candidates.h"
#include "pipeline/evidence.h"
#include "stages/reference_host.h"
#include "support/box_mesh.h"
#include "support/shapes.h"

namespace rangepose {
namespace {

constexpr double kNoiseMm = 0.1;

/// Gives a pose the evidence of which these are the log odds.
void setRank(Candidate& candidate, double rank) {
  candidate.check.inner_px = 1e9;
  candidate.evidence = {};
  setTerm(candidate, EvidenceTerm::kOne, rank / evidenceWeights()[0]);
}

class SelectionTest : public testing::Test {
 protected:
  SelectionTest() {
    host::renderReferences(object_, channelOptionsFor(64), {});
    database_.objects = {object_};
    image_.camera = test::pinholeCamera(320, 240, 300.0);
    image_.depth_mm = Image<float>(320, 240, 0.0f);
    for (const double x : {-60.0, 60.0}) test::measure(image_, object_.mesh, partAt(x));
    foreground_ = Image<std::uint8_t>(320, 240, 0);
    std::transform(
        image_.depth_mm.begin(), image_.depth_mm.end(), foreground_.begin(), [](float mm) {
          return static_cast<std::uint8_t>(mm > 0.0f ? 1 : 0);
        });
  }

  Pose partAt(double x_mm) const {
    Pose pose;
    pose.rotation = rotationFromVector({-0.7, 1.9, 0.4});
    pose.translation_mm = glm::dvec3(x_mm, 0.0, 500.0) - pose.rotation * object_.center_mm;
    return pose;
  }

  /// Pixels of the foreground.
  double left() const {
    return static_cast<double>(std::count(foreground_.begin(), foreground_.end(), 1));
  }

  /// Its rank is also what its confidence follows from.
  Candidate candidateAt(double x_mm, double rank) const {
    Candidate candidate;
    candidate.pose = partAt(x_mm);
    setRank(candidate, rank);
    return candidate;
  }

  ReferenceObject object_ = describeObject(
      test::meshOf(test::bracketBoxes()), 1, 64, uniformRotations(1), channelOptionsFor(64));
  ReferenceDatabase database_;
  DepthImage image_;
  Image<std::uint8_t> foreground_;
};

TEST_F(SelectionTest, ARightPoseTakesItsPartAndNoOther) {
  const double all = left();
  ASSERT_GT(all, 0.0);
  Selection selection(image_, database_, kNoiseMm);
  selection.add({candidateAt(-60.0, 5.0)});
  selection.takeOut(foreground_);
  EXPECT_NEAR(left(), 0.5 * all, 0.02 * all);
  selection.add({candidateAt(60.0, 5.0)});
  EXPECT_EQ(selection.choose().size(), 2u);
  selection.takeOut(foreground_);
  EXPECT_EQ(left(), 0.0);
}

TEST_F(SelectionTest, OfTwoPosesOfTheSamePartTheSurerOneIsChosen) {
  for (const bool surer_first : {true, false}) {
    Selection selection(image_, database_, kNoiseMm);
    const Candidate right = candidateAt(-60.0, 3.0);
    // Shifted by more than what counts as the same pose, on the same surface.
    const Candidate shifted = candidateAt(-57.0, 1.0);
    selection.add({surer_first ? right : shifted});
    EXPECT_FALSE(selection.knows(surer_first ? shifted : right));
    selection.add({surer_first ? shifted : right});
    const std::vector<Candidate> chosen = selection.choose();
    ASSERT_EQ(chosen.size(), 1u) << "one part would be picked twice";
    EXPECT_NEAR(chosen[0].rank, 3.0, 1e-9) << "whichever was found first";
  }
}

TEST_F(SelectionTest, OfLikePosesTheSurestStays) {
  Selection selection(image_, database_, kNoiseMm);
  selection.add({candidateAt(-60.0, 1.0), candidateAt(-60.1, 2.0), candidateAt(-60.2, 0.5)});
  ASSERT_EQ(selection.choose().size(), 1u);
  EXPECT_NEAR(selection.choose()[0].rank, 2.0, 1e-9);
  EXPECT_TRUE(selection.knows(candidateAt(-60.05, 0.0))) << "it need not be checked again";
}

/// A bar, seen from above, that is the same end for end but for a step on one end.
class TurnedBarTest : public testing::Test {
 protected:
  void show(double step_mm) {
    std::vector<test::Box> boxes{{{-40.0, -12.0, 0.0}, {40.0, 12.0, 10.0}}};
    if (step_mm > 0.0) boxes.push_back({{20.0, -12.0, -step_mm}, {40.0, 12.0, 0.0}});
    ReferenceObject object =
        describeObject(test::meshOf(boxes), 1, 64, uniformRotations(1), channelOptionsFor(64));
    host::renderReferences(object, channelOptionsFor(64), {});
    database_.objects = {object};
    image_.camera = test::pinholeCamera(320, 240, 300.0);
    image_.depth_mm = Image<float>(320, 240, 0.0f);
    test::measure(image_, object.mesh, right_.pose);
    setRank(right_, 2.0);
    setRank(turned_, 2.2);
  }

  static Candidate laid(double angle_rad) {
    Candidate candidate;
    candidate.pose.rotation = rotationFromVector({0.0, 0.0, angle_rad});
    candidate.pose.translation_mm = {5.0, -8.0, 400.0};
    return candidate;
  }

  std::vector<Candidate> chosen() const {
    Selection selection(image_, database_, kNoiseMm);
    selection.add({right_, turned_});
    return selection.choose();
  }

  Candidate right_ = laid(0.0);
  Candidate turned_ = laid(std::numbers::pi);
  ReferenceDatabase database_;
  DepthImage image_;
};

TEST_F(TurnedBarTest, RivalsThatExplainAsMuchShareTheConfidence) {
  show(0.0);
  const std::vector<Candidate> poses = chosen();
  ASSERT_EQ(poses.size(), 1u) << "one part would be picked twice";
  EXPECT_NEAR(poses[0].confidence, std::exp(2.2) / (1.0 + 2.0 * std::exp(2.2)), 1e-6)
      << "either may be the right one, which a robot must know before it picks";
}

TEST_F(TurnedBarTest, OfRivalsTheOneThatFitsMoreCloselyWins) {
  // 0.8 mm is within the tolerance of the check.
  for (const double step_mm : {5.0, 0.8}) {
    show(step_mm);
    ASSERT_GT(toleranceFor(database_.objects[0], 0.1), 0.8);
    const std::vector<Candidate> poses = chosen();
    ASSERT_EQ(poses.size(), 1u) << "a part in full view is lost to a worse pose of it";
    EXPECT_NEAR(poses[0].rank, 2.0, 1e-9) << "step of " << step_mm << " mm";
    EXPECT_NEAR(poses[0].confidence, probabilityOf(2.0), 0.01);
  }
}

TEST_F(TurnedBarTest, PosesThatTheImageHardlyTellsApartAreTakenOutForACloserLook) {
  show(0.0);
  Selection selection(image_, database_, kNoiseMm);
  selection.add({right_, turned_});
  const std::vector<Candidate> ties = selection.takeTies();
  ASSERT_EQ(ties.size(), 2u);
  for (const Candidate& tie : ties) EXPECT_FALSE(selection.knows(tie)) << "it would stay as it was";
  selection.add(ties);
  EXPECT_EQ(selection.choose().size(), 1u) << "a part in full view is lost";
}

TEST_F(TurnedBarTest, WhatIsChosenIsTakenOutAsItWasFound) {
  show(5.0);
  Selection selection(image_, database_, kNoiseMm);
  selection.add({right_, turned_});
  const std::vector<Candidate> taken = selection.takeChosen();
  ASSERT_EQ(taken.size(), 1u);
  EXPECT_NEAR(taken[0].rank, right_.rank, 1e-9)
      << "what the choice made of it would be counted twice";
  EXPECT_FALSE(selection.knows(right_)) << "it would stay as it was";
  EXPECT_TRUE(selection.knows(turned_)) << "without its rivals a pose is surer than it should be";
  EXPECT_TRUE(selection.takeChosen().empty());
}

/// Half a turn about the bar's upright axis.
Pose halfTurn() { return {rotationFromVector({0.0, 0.0, std::numbers::pi}), glm::dvec3(0.0)}; }

TEST_F(TurnedBarTest, TheTwinOfAChosenPoseLiesOnIt) {
  show(0.0);
  database_.objects[0].twins = {halfTurn()};
  Selection selection(image_, database_, kNoiseMm);
  EXPECT_TRUE(selection.twinsOfChosen().empty());
  selection.add({right_});
  const std::vector<Candidate> twins = selection.twinsOfChosen();
  ASSERT_EQ(twins.size(), 1u);
  EXPECT_LT(rotationAngleBetween(twins[0].pose.rotation, turned_.pose.rotation), 1e-6);
  EXPECT_LT(glm::distance(twins[0].pose.translation_mm, turned_.pose.translation_mm), 1e-9);
}

TEST_F(TurnedBarTest, ARivalThatWasLeftALittleOffGivesWayToTheTwin) {
  show(0.0);
  database_.objects[0].twins = {halfTurn()};
  Candidate off = turned_;
  off.pose.translation_mm += glm::dvec3(1.5, 0.5, 0.6);
  Selection selection(image_, database_, kNoiseMm);
  selection.add({right_, off});
  ASSERT_EQ(selection.choose().size(), 1u);
  EXPECT_GT(selection.choose()[0].confidence, 0.7)
      << "the rival is off, so that it seems to be worse";
  selection.addTwins(selection.twinsOfChosen());
  const std::vector<Candidate> poses = selection.choose();
  ASSERT_EQ(poses.size(), 1u);
  EXPECT_LT(poses[0].confidence, 0.5) << "nothing tells which way round the bar lies";
}

TEST_F(TurnedBarTest, ATwinThatThePixelsAreAgainstDoesNotReplaceAnything) {
  show(0.0);
  database_.objects[0].twins = {halfTurn()};
  database_.objects[0].twins[0].translation_mm = {1.5, 0.5, 0.6};
  Selection selection(image_, database_, kNoiseMm);
  selection.add({right_, turned_});
  selection.addTwins(selection.twinsOfChosen());
  ASSERT_EQ(selection.choose().size(), 1u);
  EXPECT_LT(selection.choose()[0].confidence, 0.5) << "the rival that lies right is gone";
}

TEST_F(TurnedBarTest, WhatIsDecidedIsNotLookedAtAgain) {
  show(5.0);
  Selection selection(image_, database_, kNoiseMm);
  selection.add({right_, turned_});
  EXPECT_TRUE(selection.takeTies().empty());
  EXPECT_EQ(selection.choose().size(), 1u);
}

TEST_F(SelectionTest, WhereAPoseIsLikelyButNotSureASecondLookIsTaken) {
  Selection selection(image_, database_, kNoiseMm);
  const double before = left();
  selection.add({candidateAt(-60.0, 1.0)});
  EXPECT_EQ(selection.choose().size(), 1u);
  selection.takeOut(foreground_);
  EXPECT_EQ(left(), before) << "a wrong pose keeps the right one from being found";
}

TEST_F(SelectionTest, HopelessPosesClaimNothing) {
  Selection selection(image_, database_, kNoiseMm);
  const double before = left();
  selection.add({candidateAt(-60.0, -5.0)});
  EXPECT_TRUE(selection.choose().empty());
  selection.takeOut(foreground_);
  EXPECT_EQ(left(), before);
}

TEST_F(SelectionTest, EachPoseIsTurnedOnceAndHopelessOnesNever) {
  Selection selection(image_, database_, kNoiseMm);
  selection.add({candidateAt(-60.0, 2.0), candidateAt(60.0, -3.5)});
  const std::vector<Candidate> copies = selection.turnedCopies();
  ASSERT_FALSE(copies.empty());
  for (const Candidate& copy : copies) {
    EXPECT_EQ(copy.window, 0);
    const double x_mm = (copy.pose * object_.center_mm).x;
    EXPECT_LT(x_mm, 0.0) << "the other pose is as good as wrong";
  }
  EXPECT_TRUE(selection.turnedCopies().empty());
  selection.add({candidateAt(60.0, 1.0)});
  EXPECT_EQ(selection.turnedCopies().size(), copies.size());
}

}  // namespace
}  // namespace rangepose
