#include "debug/dump.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <sstream>

#include "core/error.h"
#include "debug/plots.h"
#include "debug/scenes.h"
#include "debug/small_database.h"
#include "debug/stage_pictures.h"
#include "stages/channels_host.h"

namespace rangepose::debug {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::smallObject;
using testing::smallScene;
using testing::someHypotheses;

std::string textOf(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

class DumpTest : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::path(::testing::TempDir()) / (std::string("rangepose_dump_") + info->name());
    fs::remove_all(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  /// Every kind of picture once.
  void addAll(StageDump& dump) const {
    const DepthImage image = testing::scan(mesh_, pose_, 500.0f);
    Image<std::uint8_t> keep(160, 120, 1);
    for (int x = 0; x < 160; ++x) keep.at(x, 5) = 0;
    const SceneChannels scene = smallScene(90, 70);
    const std::vector<SceneChannels> windows = {smallScene(64, 64), smallScene(64, 64)};
    const ReferenceObject object = smallObject(10);
    const std::vector<Hypothesis> hypotheses = someHypotheses(10, 2);
    dump.addDepth(image);
    dump.addKeepMask(image, keep);
    dump.addRange(scene.camera, scene.range_px);
    dump.addChannels(scene);
    dump.addPatches(host::patches(scene.range_px, scene.edges));
    dump.addSeeds(
        scene,
        {{45.0f, 35.0f, 104.5f, 4.0f, 104.0f, 1500}, {40.0f, 30.0f, 104.0f, 4.0f, 104.0f, 900}});
    dump.addWindows(windows);
    dump.addAtlas(object);
    dump.addErrors(object, hypotheses);
    dump.addBestViews(object, windows, hypotheses);
    dump.addOverlay("rough", image, {testing::posed(mesh_, pose_)});
    dump.addOverlay("fine", image, {testing::posed(mesh_, pose_)});
  }

  fs::path folder_;
  const Mesh mesh_ = testing::box(60, 40, 20);
  const Pose pose_ = testing::facing(0, 0, 300);
};

TEST_F(DumpTest, PageListsEveryPictureInOrderAndEachOneDecodes) {
  StageDump dump(folder_ / "deep" / "er", "one frame");
  addAll(dump);
  dump.addSensor({.noise_mm = 0.125, .error_mm = 0.755});
  dump.finish({{"prepare", 2.5}, {"search", 31.25}}, {testing::posed(mesh_, pose_)});

  const std::string page = textOf(dump.directory() / "index.html");
  EXPECT_THAT(page, HasSubstr("0.755")) << "what tolerances go by";
  ASSERT_EQ(dump.entries().size(), 14U);
  std::size_t last = 0;
  for (const DumpEntry& entry : dump.entries()) {
    const std::size_t at = page.find("<img src=\"" + entry.file + "\"");
    ASSERT_NE(at, std::string::npos) << entry.file;
    EXPECT_GT(at, last) << entry.file;
    last = at;
    EXPECT_THAT(page, HasSubstr(entry.title));
    const cv::Mat picture = cv::imread((dump.directory() / entry.file).string(), cv::IMREAD_COLOR);
    EXPECT_EQ(picture.size(), cv::Size(entry.width, entry.height)) << entry.file;
  }
  std::size_t files = 0;
  for (const fs::directory_entry& file : fs::directory_iterator(dump.directory())) {
    EXPECT_TRUE(file.path().extension() == ".png" || file.path().filename() == "index.html")
        << file.path();
    ++files;
  }
  EXPECT_EQ(files, dump.entries().size() + 1) << "no temporary files stay behind";
}

TEST_F(DumpTest, PageShowsTimesAndPosesAndNeedsNothingFromElsewhere) {
  StageDump dump(folder_, "bin <3> & \"more\"");
  dump.addDepth(testing::scan(mesh_, pose_, 500.0f));
  OverlayPose pose = testing::posed(mesh_, testing::facing(12.25, -3.5, 300.0));
  pose.label = "<elbow>";
  dump.finish({{"search", 31.25}}, {pose});
  const std::string page = textOf(folder_ / "index.html");
  EXPECT_THAT(page, HasSubstr("31.25"));
  EXPECT_THAT(page, HasSubstr("12.25, -3.50, 300.00"));
  EXPECT_THAT(page, HasSubstr("0.7500"));
  EXPECT_THAT(page, HasSubstr("bin &lt;3&gt; &amp; &quot;more&quot;"));
  EXPECT_THAT(page, HasSubstr("&lt;elbow&gt;"));
  EXPECT_THAT(page, Not(HasSubstr("<script")));
  EXPECT_THAT(page, Not(HasSubstr("http")));
}

TEST_F(DumpTest, NoPoseIsSaidInWords) {
  StageDump dump(folder_, "empty");
  dump.finish({}, {});
  EXPECT_THAT(textOf(folder_ / "index.html"), HasSubstr("None was found."));
}

TEST_F(DumpTest, SecondDumpReplacesTheFirstAndLeavesOtherFilesAlone) {
  fs::create_directories(folder_);
  std::ofstream(folder_ / "01_depth.png") << "not a picture";
  std::ofstream(folder_ / "notes.txt") << "mine";
  StageDump dump(folder_, "again");
  dump.addDepth(testing::scan(mesh_, pose_, 500.0f));
  dump.finish({}, {});
  EXPECT_FALSE(cv::imread((folder_ / "01_depth.png").string()).empty());
  EXPECT_EQ(textOf(folder_ / "notes.txt"), "mine");
}

TEST_F(DumpTest, FolderThatCannotBeMadeIsAnErrorThatNamesIt) {
  std::ofstream(folder_.string()) << "a file";
  for (const fs::path& wrong : {folder_, folder_ / "below"}) {
    try {
      const StageDump dump(wrong, "wrong");
      FAIL() << wrong << " was accepted";
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), HasSubstr(wrong.string()));
    }
  }
}

TEST_F(DumpTest, FolderThatWentAwayIsAnError) {
  StageDump dump(folder_, "gone");
  fs::remove_all(folder_);
  EXPECT_THROW(dump.addDepth(testing::scan(mesh_, pose_, 500.0f)), Error);
  EXPECT_TRUE(dump.entries().empty()) << "a picture that was not written is not listed";
  EXPECT_THROW(dump.finish({}, {}), Error);
}

TEST_F(DumpTest, EmptyResultsGivePicturesToo) {
  StageDump dump(folder_, "nothing found");
  const SceneChannels scene = smallScene(90, 70);
  dump.addKeepMask(testing::scan(mesh_, pose_, 0.0f), {});
  dump.addPatches(Image<std::int32_t>(90, 70, kNoPatch));
  dump.addSeeds(scene, {});
  dump.addWindows({});
  dump.addErrors(smallObject(3), {});
  dump.addBestViews(smallObject(3), {}, {});
  for (const DumpEntry& entry : dump.entries()) {
    EXPECT_FALSE(cv::imread((folder_ / entry.file).string()).empty()) << entry.file;
  }
}

TEST_F(DumpTest, HypothesisOfAViewThatDoesNotExistIsAnError) {
  const ReferenceObject object = smallObject(3);
  const std::vector<Hypothesis> wrong = someHypotheses(4, 1);
  EXPECT_THROW(errorOverDirections(object, wrong), Error);
  EXPECT_THROW(atlasPicture(object, 3, 1), Error);
}

}  // namespace
}  // namespace rangepose::debug
