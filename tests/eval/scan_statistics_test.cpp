// Statistics of whole data sets, and their table.
#include "eval/scan_statistics.h"

#include <gmock/gmock.h>

#include <filesystem>

#include "core/parallel.h"
#include "eval/bop_folder.h"
#include "eval/scan_statistics_report.h"

namespace rangepose {
namespace {

using test::BopFolderOfParts;
using test::errorOf;
using testing::AllOf;
using testing::HasSubstr;

TEST(ScanSets, PartsThatAreHalfVisibleCount) {
  const BopFolderOfParts folder;
  const ScanStatistics figures = measureScans({folder.path()});
  EXPECT_EQ(figures.name, folder.path().filename().string());
  EXPECT_EQ(figures.images, 3);
  EXPECT_EQ(figures.parts, 6) << "one of three is only 30 % visible";
  EXPECT_NEAR(figures.common_step_mm, 0.1, 1e-9);
  EXPECT_NEAR(figures.rms_mm, 0.1 / std::sqrt(12.0), 0.01) << "depth comes in steps of 0.1 mm";
  EXPECT_EQ(figures.lost_share, 0.0);
}

TEST(ScanSets, TruthOfAFileReplacesTheSetsOwn) {
  const BopFolderOfParts folder;
  std::filesystem::remove(folder.path() / "test/000004/scene_gt_info.json");
  std::filesystem::rename(folder.path() / "test/000004/scene_gt.json",
                          folder.path() / "poses.json");
  EXPECT_THAT(errorOf([&] { measureScans({folder.path()}); }), HasSubstr("scene_gt.json"));
  ScanSet set{folder.path() / ""};
  set.truth = folder.path() / "poses.json";
  const ScanStatistics figures = measureScans(set);
  EXPECT_EQ(figures.name, folder.path().filename().string()) << "whatever slash ends the path";
  EXPECT_EQ(figures.parts, 9) << "visible fractions are not known";
  folder.write("poses.json", "{\"1\":[" + test::poseJson(1, BopFolderOfParts::truth(1, 0)) + "]}");
  const ScanStatistics one = measureScans(set);
  EXPECT_EQ(one.images, 1) << "images without poses are left out";
  EXPECT_EQ(one.parts, 1);
}

TEST(ScanSets, SameFiguresOnAnyNumberOfThreads) {
  const BopFolderOfParts folder;
  setThreadCount(1);
  const std::string one = scanCsv({measureScans({folder.path()})});
  setThreadCount(4);
  const std::string four = scanCsv({measureScans({folder.path()})});
  setThreadCount(0);
  EXPECT_EQ(one, four);
}

TEST(ScanSets, BadInputIsNamed) {
  const BopFolderOfParts folder;
  ScanSet set{folder.path()};
  set.truth = folder.path() / "none.json";
  EXPECT_THAT(errorOf([&] { measureScans(set); }), AllOf(HasSubstr("none.json"), HasSubstr("no")));
  set.truth = folder.write("poses.json", "{}");
  EXPECT_THAT(errorOf([&] { measureScans(set); }), HasSubstr("no image has a part"));
  set.truth = folder.write("poses.json",
                           "{\"0\":[" + test::poseJson(7, BopFolderOfParts::truth(0, 0)) + "]}");
  EXPECT_THAT(errorOf([&] { measureScans(set); }),
              AllOf(HasSubstr("object 7"), HasSubstr("obj_000007.ply")));
  std::filesystem::create_directories(folder.path() / "test/000005");
  std::filesystem::copy(folder.path() / "test/000004",
                        folder.path() / "test/000005",
                        std::filesystem::copy_options::recursive);
  EXPECT_THAT(errorOf([&] { measureScans(set); }), HasSubstr("2 scenes"));
}

TEST(ScanReport, AColumnForEachSet) {
  ScanStatistics first;
  first.name = "real";
  first.images = 2;
  first.parts = 7;
  first.noise_mm = 0.25;
  first.places[0].lost = 0.125;
  ScanStatistics second = first;
  second.name = "simulated";
  second.noise_mm = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(
      scanMarkdown({first, second}),
      AllOf(HasSubstr("| figure | real (2 images, 7 parts) | simulated (2 images, 7 parts) |"),
            HasSubstr("| noise between neighbours [mm] | 0.250 | - |"),
            HasSubstr("| jumps: lost -6 px outside [%] | 12.5 | 12.5 |")));
  EXPECT_THAT(scanCsv({first, second}),
              AllOf(HasSubstr("figure,real,simulated\n\"images\",2,2\n\"parts\",7,7\n"),
                    HasSubstr("\"noise between neighbours [mm]\",0.25,\n")));
}

}  // namespace
}  // namespace rangepose
