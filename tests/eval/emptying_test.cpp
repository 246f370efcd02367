#include "eval/emptying.h"

#include <gmock/gmock.h>

#include <set>

#include "core/error.h"
#include "eval/eval_support.h"
#include "support/box_mesh.h"

namespace rangepose {
namespace {

/// Four brackets beside each other, 60 mm apart, and a fifth under the second one.
class EmptyingTest : public testing::Test {
 protected:
  EmptyingTest() {
    bin_.mesh = &mesh_;
    bin_.number = 7;
    bin_.inner_mm = {260.0, 100.0, 60.0};
    for (int i = 0; i < 4; ++i) bin_.bin_from_object.push_back(at(60.0 * i - 110.0, 30.0));
    bin_.bin_from_object.push_back(at(-48.0, 0.0));
  }
  static Pose at(double x, double z) {
    Pose pose;
    pose.translation_mm = {x, 0.0, z};
    return pose;
  }
  std::vector<Trial> empty(const Answerer& answer, const TrialObserver& observe = {}) const {
    BinScanOptions options;
    options.pixel_mm = 1.0;
    return emptyBin(bin_, model_, options, answer, observe);
  }

  const Mesh mesh_ = test::meshOf(test::bracketBoxes());
  const ErrorModel model_{mesh_, {}};
  VirtualBin bin_;
};

TEST_F(EmptyingTest, TheScanShowsWhatIsLeft) {
  BinScanOptions options;
  options.pixel_mm = 1.0;
  const BinScan scan = scanVirtualBin(bin_, {false, true, false, false, true}, options);
  EXPECT_EQ(scan.image.camera.width, 260);
  EXPECT_EQ(scan.image.camera.height, 100);
  EXPECT_TRUE(scan.image.camera.orthographic);
  EXPECT_THAT(scan.parts, testing::ElementsAre(1, 4));
  EXPECT_EQ(scan.visible_fractions[0], 1.0);
  EXPECT_LT(scan.visible_fractions[1], 0.2) << "under the other one";
  // The top of the lower arm of part 1, 40 mm over the floor; the floor beside it.
  const glm::dvec3 top = scan.truth[0] * glm::dvec3(30.0, 6.0, 10.0);
  const glm::dvec2 pixel = scan.image.camera.project(top);
  const auto depth = [&](double u, double v) {
    return scan.image.depth_mm.at(static_cast<int>(std::lround(u)),
                                  static_cast<int>(std::lround(v)));
  };
  EXPECT_NEAR(depth(pixel.x, pixel.y), top.z, 1e-3);
  EXPECT_NEAR(depth(250.0, 50.0), top.z + 40.0, 1e-3);
  EXPECT_NEAR(scan.bin.camera_from_bin.translation_mm.z, top.z + 40.0, 1e-9);
  EXPECT_THROW(scanVirtualBin(bin_, std::vector<bool>(5, false), options), Error);
  EXPECT_THROW(scanVirtualBin(bin_, {true}, options), Error);
}

TEST_F(EmptyingTest, PinholeScanSeesTheSameParts) {
  BinScanOptions options;
  options.orthographic = false;
  const BinScan scan = scanVirtualBin(bin_, std::vector<bool>(5, true), options);
  EXPECT_FALSE(scan.image.camera.orthographic);
  EXPECT_EQ(scan.image.camera.width, 640);
  for (int i = 0; i < 4; ++i) EXPECT_GT(scan.visible_fractions[static_cast<std::size_t>(i)], 0.95);
  EXPECT_LT(scan.visible_fractions[4], 0.3);
  for (const Pose& truth : scan.truth) {
    const glm::dvec2 pixel = scan.image.camera.project(truth * glm::dvec3(20.0, 6.0, 5.0));
    EXPECT_GT(pixel.x, 0.0);
    EXPECT_LT(pixel.x, 639.0);
  }
  options.pixel_mm = 0.0;
  EXPECT_THROW(options.check(), Error);
}

TEST_F(EmptyingTest, RightAnswersTakeTheirParts) {
  std::multiset<int> left;
  const std::vector<Trial> trials = empty(
      [](const BinScan& scan) {
        TrialAnswer answer;
        answer.search = answer.rough = answer.fine = scan.truth.back();
        answer.score = 0.9;
        return answer;
      },
      [&left](const Trial& trial, const BinScan& scan, const TrialAnswer& answer) {
        left.insert(static_cast<int>(scan.parts.size()));
        EXPECT_EQ(trial.score, answer.score);
      });
  ASSERT_EQ(trials.size(), 5u);
  EXPECT_THAT(left, testing::ElementsAre(1, 2, 3, 4, 5));
  for (int i = 0; i < 5; ++i) {
    const Trial& trial = trials[static_cast<std::size_t>(i)];
    EXPECT_EQ(trial.bin, 7);
    EXPECT_EQ(trial.number, i);
    EXPECT_TRUE(trial.fine.right && trial.rough.right && trial.search.right);
    EXPECT_EQ(trial.fine.vertex, 0.0);
    EXPECT_EQ(trial.fine.part, 4 - i);
    EXPECT_EQ(trial.best_visible, 1.0);
  }
  EXPECT_LT(trials[0].visible, 0.2);
}

TEST_F(EmptyingTest, WrongAnswersFailAndTakeTheNearestPart) {
  // 8 mm beside part 0 as long as it is there: 8 mm of the diagonal's 54 mm.
  const glm::dvec3 shift(-8.0, 0.0, 0.0);
  std::vector<std::vector<int>> left;
  const std::vector<Trial> trials = empty(
      [&shift](const BinScan& scan) {
        TrialAnswer answer;
        answer.rough = scan.truth.front();
        answer.fine = scan.truth.front();
        answer.fine->translation_mm += shift;
        answer.rough->translation_mm += 0.5 * shift;
        return answer;
      },
      [&left](const Trial&, const BinScan& scan, const TrialAnswer&) {
        left.push_back(scan.parts);
      });
  ASSERT_EQ(trials.size(), 5u);
  EXPECT_FALSE(trials[0].fine.right);
  EXPECT_NEAR(trials[0].fine.vertex, 8.0 / model_.diagonalMm(), 1e-9);
  EXPECT_TRUE(trials[0].rough.right);
  EXPECT_FALSE(trials[0].search.right) << "there is none";
  EXPECT_EQ(trials[0].search.part, -1);
  EXPECT_THAT(left[1], testing::ElementsAre(1, 2, 3, 4));
}

// The tables say how far the centres of parts are off: not by where a symmetric copy has its own.
TEST_F(EmptyingTest, CentreIsComparedWithThatOfTheNearestCopy) {
  Pose third;  // about a line beside the centre
  third.rotation = rotationFromVector({0.0, 0.0, 2.0944});
  third.translation_mm = {5.0, 3.0, 0.0};
  const ErrorModel model(mesh_, {{third}, {}});
  VirtualBin bin = bin_;
  bin.bin_from_object.resize(1);
  BinScanOptions options;
  options.pixel_mm = 1.0;
  const BinScan scan = scanVirtualBin(bin, {true}, options);
  const PoseGrade grade = gradePose(model, scan, scan.truth[0] * third);
  EXPECT_TRUE(grade.right);
  EXPECT_NEAR(grade.center, 0.0, 1e-9);
}

TEST_F(EmptyingTest, WithoutAnAnswerTheMostVisiblePartGoes) {
  std::vector<std::vector<int>> left;
  const std::vector<Trial> trials =
      empty([](const BinScan&) { return TrialAnswer{}; },
            [&left](const Trial&, const BinScan& scan, const TrialAnswer&) {
              left.push_back(scan.parts);
            });
  ASSERT_EQ(trials.size(), 5u);
  for (const Trial& trial : trials) EXPECT_FALSE(trial.fine.right);
  EXPECT_THAT(left.back(), testing::ElementsAre(4)) << "the hidden one comes last";
}

TEST_F(EmptyingTest, SymmetricCopyIsRight) {
  const Mesh box = test::meshOf({{{-30.0, -20.0, -10.0}, {30.0, 20.0, 10.0}}});
  const ErrorModel model(box, test::halfTurns(glm::dvec3(0.0)));
  VirtualBin bin;
  bin.mesh = &box;
  bin.inner_mm = {100.0, 100.0, 60.0};
  bin.bin_from_object = {at(0.0, 10.0)};
  const std::vector<Trial> trials =
      emptyBin(bin,
               model,
               {},
               [](const BinScan& scan) {
                 TrialAnswer answer;
                 answer.fine = scan.truth.front() * test::halfTurns(glm::dvec3(0.0)).discrete[2];
                 return answer;
               },
               {});
  ASSERT_EQ(trials.size(), 1u);
  EXPECT_EQ(trials[0].fine.vertex, 0.0);
  EXPECT_LT(trials[0].fine.rotation_rad, 1e-14);
}

}  // namespace
}  // namespace rangepose
