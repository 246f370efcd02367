#include "eval/grade_bop.h"

#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <numbers>

#include "eval/bop_folder.h"
#include "eval/bop_scores.h"
#include "eval/picking_scores.h"

namespace rangepose {
namespace {

using test::BopFolderOfParts;
using test::errorOf;
using testing::AllOf;
using testing::HasSubstr;

GradedResults grade(const BopFolderOfParts& folder, const std::vector<BopEstimate>& rows) {
  return gradeBop(openBop(folder.path()), rows);
}

TEST(GradeBop, TruthAsEstimateScoresExactlyOne) {
  const BopFolderOfParts folder;
  const GradedResults results = grade(folder, BopFolderOfParts::perfect());
  EXPECT_EQ(results.image_count, 3);
  EXPECT_EQ(results.mean_time_s, 0.25);
  EXPECT_TRUE(results.warnings.empty());
  ASSERT_EQ(results.objects.size(), 2u);
  EXPECT_EQ(results.objects[0].symmetric_poses, 1u);
  EXPECT_GT(results.objects[1].symmetric_poses, 50u);
  const BopScores bop = bopScores(results.images);
  EXPECT_EQ(bop.targets, 9);
  EXPECT_EQ(bop.vsd, 1.0);
  EXPECT_EQ(bop.mssd, 1.0);
  EXPECT_EQ(bop.mspd, 1.0);
  const PickingScores picking = pickingScores(results.images, {});
  EXPECT_EQ(picking.parts, 6) << "one of each image is only 30 % visible";
  EXPECT_EQ(picking.ignored, 3);
  EXPECT_EQ(picking.average_precision, 1.0);
  EXPECT_EQ(picking.first_pick_strict, 1.0);
  EXPECT_LT(picking.median_mssd, 1e-14) << "reading makes rotations orthonormal";
}

TEST(GradeBop, SymmetricCopiesScoreExactlyOne) {
  const BopFolderOfParts folder;
  std::vector<BopEstimate> rows = BopFolderOfParts::perfect();
  for (BopEstimate& row : rows) {
    if (row.obj_id != 2) continue;
    row.camera_from_object =
        row.camera_from_object *
        test::turnAbout(test::coneSymmetries().continuous.front(), 1.0 + row.im_id);
  }
  const GradedResults results = grade(folder, rows);
  const BopScores cone = bopScores(results.images, 2);
  EXPECT_EQ(cone.mssd, 1.0);
  EXPECT_EQ(cone.mspd, 1.0);
  EXPECT_GT(cone.vsd, 0.9) << "its facets are nearly symmetric";
  EXPECT_LT(pickingScores(results.images, {}, 2).median_mssd, 1e-6);
}

TEST(GradeBop, SymmetriesAreFoundInTheMeshWithoutModelsInfo) {
  const BopFolderOfParts folder;
  std::filesystem::remove(folder.path() / "models/models_info.json");
  // Half a turn of a box about z is one of its symmetries.
  const Mesh box = test::meshOf({{{-30.0, -20.0, -10.0}, {30.0, 20.0, 10.0}}});
  folder.write("models/obj_000001.ply", test::plyText(box));
  std::vector<BopEstimate> rows = BopFolderOfParts::perfect();
  for (BopEstimate& row : rows) {
    row.camera_from_object =
        row.camera_from_object * Pose{rotationFromVector({0.0, 0.0, std::numbers::pi}), {0, 0, 0}};
  }
  const GradedResults results = grade(folder, rows);
  EXPECT_EQ(results.objects[0].symmetric_poses, 4u);
  EXPECT_EQ(bopScores(results.images, 1).mssd, 1.0);
}

TEST(GradeBop, WrongAndMissingPosesCost) {
  const BopFolderOfParts folder;
  std::vector<BopEstimate> rows = BopFolderOfParts::perfect();
  rows.erase(rows.begin() + 8);                          // the cone of image 2 is missed
  rows[0].camera_from_object.translation_mm.x += 6.0;    // 6 mm of 53 mm: 0.11 diameters
  rows[3].camera_from_object.translation_mm.z -= 300.0;  // far off
  const GradedResults results = grade(folder, rows);
  const PickingScores picking = pickingScores(results.images, {});
  EXPECT_DOUBLE_EQ(picking.recall, 3.0 / 6.0);
  EXPECT_DOUBLE_EQ(picking.first_pick, 1.0 / 3.0);
  EXPECT_DOUBLE_EQ(picking.precision, 3.0 / 5.0);
  // MSSD: 0.11 is right at 8 of 10 thresholds.
  EXPECT_NEAR(bopScores(results.images).mssd, (6.0 + 0.8) / 9.0, 1e-12);
}

TEST(GradeBop, TargetsOfTheDataSetAreUsed) {
  const BopFolderOfParts folder;
  folder.write("test_targets_bop19.json",
               R"([{"scene_id":4,"im_id":1,"obj_id":1,"inst_count":1}])");
  std::vector<BopEstimate> rows = BopFolderOfParts::perfect();
  std::erase_if(rows, [](const BopEstimate& row) { return row.im_id != 1; });
  const GradedResults results = grade(folder, rows);
  EXPECT_EQ(results.image_count, 1);
  EXPECT_EQ(bopScores(results.images).targets, 1);
  EXPECT_EQ(bopScores(results.images).mssd, 1.0);
}

TEST(GradeBop, WithoutVisibilityAllPartsCount) {
  const BopFolderOfParts folder;
  std::filesystem::remove(folder.path() / "test/000004/scene_gt_info.json");
  const GradedResults results = grade(folder, BopFolderOfParts::perfect());
  ASSERT_EQ(results.warnings.size(), 1u);
  EXPECT_THAT(results.warnings[0], HasSubstr("scene_gt_info.json"));
  EXPECT_EQ(pickingScores(results.images, {}).parts, 9);
}

TEST(GradeBop, BadInputIsNamed) {
  const BopFolderOfParts folder;
  const auto failure = [&folder](const auto& change) {
    std::vector<BopEstimate> rows = BopFolderOfParts::perfect();
    change(rows.front());
    return errorOf([&] { grade(folder, rows); });
  };
  EXPECT_THAT(failure([](BopEstimate& row) { row.im_id = 77; }),
              AllOf(HasSubstr("scene 4 image 77"), HasSubstr("not in the data set")));
  EXPECT_THAT(failure([](BopEstimate& row) { row.scene_id = 5; }), HasSubstr("scene 5 image 0"));
  EXPECT_THAT(failure([](BopEstimate& row) { row.obj_id = 30; }),
              AllOf(HasSubstr("object 30"), HasSubstr("obj_000030.ply")));
  std::filesystem::remove(folder.path() / "test/000004/scene_gt_info.json");
  folder.write("test/000004/scene_gt.json", R"({"0":[]})");
  EXPECT_THAT(failure([](BopEstimate&) {}),
              AllOf(HasSubstr("scene_gt.json"), HasSubstr("image 1")));
  std::filesystem::remove(folder.path() / "test/000004/scene_gt.json");
  EXPECT_THAT(failure([](BopEstimate&) {}),
              AllOf(HasSubstr("scene_gt.json"), HasSubstr("no such")));
}

TEST(GradeBop, ProgressCountsAllImages) {
  const BopFolderOfParts folder;
  std::vector<int> seen;
  gradeBop(openBop(folder.path()), {}, {}, [&seen](int done, int total) {
    EXPECT_EQ(total, 3);
    seen.push_back(done);
  });
  EXPECT_THAT(seen, testing::ElementsAre(1, 2, 3));
}

}  // namespace
}  // namespace rangepose
