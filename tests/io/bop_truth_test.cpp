// Truth of a scene, and result files, as read.
#include "io/bop_truth.h"

#include <gmock/gmock.h>

#include <string>

#include "io/bop.h"
#include "io/io_support.h"

namespace rangepose {
namespace {

using test::errorOf;
using test::TempFolder;
using testing::AllOf;
using testing::HasSubstr;

const char* const kTruth =
    R"({"12": [{"cam_R_m2c": [0, -1, 0, 1, 0, 0, 0, 0, 1], "cam_t_m2c": [1, 2, 700], "obj_id": 5},
               {"cam_R_m2c": [1, 0, 0, 0, 1, 0, 0, 0, 1], "cam_t_m2c": [0, 0, 600], "obj_id": 2}],
        "3": []})";

TEST(BopTruth, ReadsPosesAndVisibility) {
  const TempFolder folder;
  folder.write("scene_gt.json", kTruth);
  folder.write(
      "scene_gt_info.json",
      R"({"3": [], "12": [{"visib_fract": 0.25}, {"visib_fract": 1, "px_count_all": 9}]})");
  const auto truth = readBopTruth(folder.path());
  ASSERT_EQ(truth.size(), 2u);
  EXPECT_TRUE(truth.at(3).empty());
  ASSERT_EQ(truth.at(12).size(), 2u);
  const BopTruth& first = truth.at(12)[0];
  EXPECT_EQ(first.obj_id, 5);
  EXPECT_EQ(first.visible_fraction, 0.25);
  EXPECT_EQ(first.camera_from_object * glm::dvec3(1.0, 0.0, 0.0), glm::dvec3(1.0, 3.0, 700.0));
  EXPECT_EQ(truth.at(12)[1].visible_fraction, 1.0);
}

TEST(BopTruth, VisibilityMayBeMissing) {
  const TempFolder folder;
  folder.write("scene_gt.json", kTruth);
  EXPECT_FALSE(readBopTruth(folder.path()).at(12)[0].visible_fraction.has_value());
}

TEST(BopTruth, AFileOfAnyNameIsTruth) {
  const TempFolder folder;
  const auto path = folder.write("poses.json", kTruth);
  folder.write("scene_gt_info.json", "{}");
  const auto truth = readBopTruthFile(path);
  ASSERT_EQ(truth.at(12).size(), 2u);
  EXPECT_EQ(truth.at(12)[1].obj_id, 2);
  EXPECT_FALSE(truth.at(12)[1].visible_fraction.has_value());
  EXPECT_THAT(errorOf([&] { readBopTruthFile(folder.path() / "none.json"); }),
              AllOf(HasSubstr("none.json"), HasSubstr("no such file")));
}

TEST(BopTruth, DamageIsNamed) {
  const TempFolder folder;
  const auto failure = [&folder] { return errorOf([&] { readBopTruth(folder.path()); }); };
  EXPECT_THAT(failure(), AllOf(HasSubstr("scene_gt.json"), HasSubstr("no such file")));
  folder.write("scene_gt.json", R"({"x": []})");
  EXPECT_THAT(failure(), HasSubstr("image id"));
  folder.write("scene_gt.json", R"({"1": {}})");
  EXPECT_THAT(failure(), AllOf(HasSubstr("image 1"), HasSubstr("array")));
  folder.write("scene_gt.json", R"({"1": [7]})");
  EXPECT_THAT(failure(), AllOf(HasSubstr("image 1"), HasSubstr("objects")));
  folder.write("scene_gt.json", R"({"1": [{"obj_id": 1, "cam_t_m2c": [0, 0, 1]}]})");
  EXPECT_THAT(failure(), AllOf(HasSubstr("part 0"), HasSubstr("cam_R_m2c")));
  folder.write("scene_gt.json", kTruth);
  folder.write("scene_gt_info.json", R"({"3": [], "12": [{"visib_fract": 0.25}]})");
  EXPECT_THAT(failure(), AllOf(HasSubstr("1 parts"), HasSubstr("2")));
  folder.write("scene_gt_info.json", R"({"3": []})");
  EXPECT_THAT(failure(), AllOf(HasSubstr("image 12"), HasSubstr("missing")));
  folder.write("scene_gt_info.json",
               R"({"3": [], "12": [{"visib_fract": 2}, {"visib_fract": 1}]})");
  EXPECT_THAT(failure(), HasSubstr("visib_fract"));
}

const std::string kHeader = "scene_id,im_id,obj_id,score,R,t,time\n";

TEST(BopResultFile, ReadsWhatItWrites) {
  const TempFolder folder;
  BopEstimate row{4, 7, 2, 0.625, {}, 0.125};
  row.camera_from_object.rotation = rotationFromVector({0.3, -1.0, 0.5});
  row.camera_from_object.translation_mm = {1.5, -2.25, 700.0};
  BopEstimate untimed{5, 0, 1, -3.0, {}, -1.0};
  const auto path = folder.path() / "r.csv";
  writeBopCsv(path, {row, untimed});
  const std::vector<BopEstimate> rows = readBopCsv(path);
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0].scene_id, 4);
  EXPECT_EQ(rows[0].im_id, 7);
  EXPECT_EQ(rows[0].obj_id, 2);
  EXPECT_EQ(rows[0].score, 0.625);
  EXPECT_EQ(rows[0].time_s, 0.125);
  EXPECT_EQ(rows[0].camera_from_object.translation_mm, row.camera_from_object.translation_mm);
  EXPECT_LT(
      rotationAngleBetween(rows[0].camera_from_object.rotation, row.camera_from_object.rotation),
      1e-8);
  EXPECT_EQ(rows[1].time_s, -1.0);
  EXPECT_EQ(rows[1].score, -3.0);
}

TEST(BopResultFile, ReadsOtherPeoplesFiles) {
  const TempFolder folder;
  const auto path = folder.write("r.csv",
                                 "scene_id,im_id,obj_id,score,R,t,time\r\n1, 2 ,3,1e-1,1.0 0 0  0 "
                                 "1 0 0 0 1 , 1 2 3,0.5\r\n\r\n");
  const std::vector<BopEstimate> rows = readBopCsv(path);
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_EQ(rows[0].im_id, 2);
  EXPECT_EQ(rows[0].score, 0.1);
  EXPECT_TRUE(readBopCsv(folder.write("empty.csv", kHeader)).empty());
}

TEST(BopResultFile, DamagedRowsAreNamedByLine) {
  const TempFolder folder;
  const std::string good = "1,2,3,0.5,1 0 0 0 1 0 0 0 1,1 2 3,0.5\n";
  const auto failure = [&](const std::string& text) {
    const auto path = folder.write("r.csv", text);
    return errorOf([&] { readBopCsv(path); });
  };
  EXPECT_THAT(failure("1,2,3\n"), AllOf(HasSubstr("r.csv"), HasSubstr("line 1")));
  EXPECT_THAT(failure(kHeader + good + "1,2,3,0.5,1 0 0 0 1 0 0 0 1,1 2 3\n"),
              AllOf(HasSubstr("line 3"), HasSubstr("6 columns")));
  EXPECT_THAT(failure(kHeader + "1,2,x,0.5,1 0 0 0 1 0 0 0 1,1 2 3,0.5\n"),
              AllOf(HasSubstr("line 2"), HasSubstr("obj_id"), HasSubstr("\"x\"")));
  EXPECT_THAT(failure(kHeader + "1,2,-3,0.5,1 0 0 0 1 0 0 0 1,1 2 3,0.5\n"), HasSubstr("obj_id"));
  EXPECT_THAT(failure(kHeader + "1,2,3,nan,1 0 0 0 1 0 0 0 1,1 2 3,0.5\n"), HasSubstr("score"));
  EXPECT_THAT(failure(kHeader + "1,2,3,0.5,1 0 0 0 1 0 0 0,1 2 3,0.5\n"), HasSubstr("R has 8"));
  EXPECT_THAT(failure(kHeader + "1,2,3,0.5,1 0 0 0 1 0 0 0 2,1 2 3,0.5\n"),
              HasSubstr("rotation matrix"));
  EXPECT_THAT(failure(kHeader + "1,2,3,0.5,1 0 0 0 1 0 0 0 1,1 2,0.5\n"), HasSubstr("t has 2"));
  EXPECT_THAT(failure(kHeader + "1,2,3,0.5,1 0 0 0 1 0 0 0 1,1 2 3,soon\n"), HasSubstr("time"));
  EXPECT_THAT(failure(kHeader + good + "1,2,3,0.5,1 0 0 0 1 0 0 0 1,1 2 3,0.6\n"),
              AllOf(HasSubstr("line 3"), HasSubstr("time"), HasSubstr("image 2")));
}

}  // namespace
}  // namespace rangepose
