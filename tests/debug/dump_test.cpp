#include "debug/dump.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <regex>
#include <sstream>

#include "core/error.h"
#include "debug/colour.h"
#include "debug/plots.h"
#include "debug/scenes.h"
#include "debug/stage_pictures.h"
#include "stages/channels_host.h"

namespace rangepose::debug {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::Not;

/// A few views of a box about z, as the database would hold them.
ReferenceObject smallObject(int views) {
  ReferenceObject object;
  object.mesh = testing::box(60, 40, 20);
  object.radius_mm = boundingSphere(object.mesh).radius_mm;
  object.diameter_mm = diameter(object.mesh);
  object.size = 32;
  object.edt_passes = 4;
  object.pixel_mm = object.diameter_mm / 28.0;
  const int columns = atlasColumns(views);
  object.atlas = Image<ReferenceTexel>(
      columns * 32, (views + columns - 1) / columns * 32, ReferenceTexel(0.0f));
  for (int i = 0; i < views; ++i) {
    ReferenceView view;
    view.rotation = rotationFromVector({0.4 * i, 0.0, 0.0});
    Camera camera;
    camera.width = camera.height = 32;
    camera.cx = camera.cy = 15.5;
    camera.orthographic = true;
    camera.pixel_size_mm = object.pixel_mm;
    Pose pose{view.rotation, {0.0, 0.0, 32.0 * object.pixel_mm}};
    const Image<SurfaceTexel> seen =
        host::renderSurface(object.mesh, camera, pose, {0, 0, 32, 32, 1});
    const glm::ivec2 origin = object.tileOrigin(i);
    for (int y = 0; y < 32; ++y) {
      for (int x = 0; x < 32; ++x) {
        const SurfaceTexel& texel = seen.at(x, y);
        if (texel.w <= 0.0f) continue;
        const float range = texel.w / static_cast<float>(object.pixel_mm);
        object.atlas.at(origin.x + x, origin.y + y) = {2.0f, range, 0.0f, std::abs(texel.z)};
        view.area_px += 1.0f;
      }
    }
    object.views.push_back(view);
  }
  return object;
}

SceneChannels smallScene(int width, int height) {
  Image<float> range(width, height, 0.0f);
  for (int y = height / 4; y < 3 * height / 4; ++y) {
    for (int x = width / 4; x < 3 * width / 4; ++x)
      range.at(x, y) = 100.0f + 0.1f * static_cast<float>(x);
  }
  OrthoCamera camera;
  camera.width = width;
  camera.height = height;
  camera.pixel_mm = 2.5;
  ChannelOptions options;
  options.image_width_px = 32;
  options.edt_passes = 4;
  return host::channels(camera, range, options);
}

std::vector<Hypothesis> someHypotheses(int views, int windows) {
  std::vector<Hypothesis> result;
  for (int w = 0; w < windows; ++w) {
    for (int v = 0; v < views; ++v) {
      Hypothesis hypothesis;
      hypothesis.view = v;
      hypothesis.window = w;
      hypothesis.translation_px = {1.0f, -2.0f, 100.0f};
      hypothesis.error =
          v == 1 ? kWorstError : 1.0f + 0.1f * static_cast<float>((v * 7 + w) % views);
      result.push_back(hypothesis);
    }
  }
  return result;
}

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
  dump.finish({{"prepare", 2.5}, {"search", 31.25}}, {testing::posed(mesh_, pose_)});

  const std::string page = textOf(dump.directory() / "index.html");
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

/// How many pixels have a colour.
int countOf(const cv::Mat& picture, const cv::Vec3b& colour) {
  int count = 0;
  for (int y = 0; y < picture.rows; ++y) {
    for (int x = 0; x < picture.cols; ++x) count += picture.at<cv::Vec3b>(y, x) == colour ? 1 : 0;
  }
  return count;
}

TEST(StagePictureTest, BackgroundIsTintedOnlyWhereItIsNotKept) {
  const Mesh mesh = testing::box(60, 40, 20);
  const DepthImage image = testing::scan(mesh, testing::facing(0, 0, 300), 500.0f);
  Image<std::uint8_t> keep(160, 120, 1);
  for (int y = 0; y < 120; ++y) {
    for (int x = 0; x < 80; ++x) keep.at(x, y) = 0;
  }
  const cv::Mat picture = keepMaskPicture(image, keep);
  const int zoom = 960 / 160;
  const int top = picture.rows - 120 * zoom;
  EXPECT_EQ(testing::toneOf(picture.at<cv::Vec3b>(top + 60 * zoom, 20 * zoom)),
            testing::Tone::kRed);
  EXPECT_EQ(testing::toneOf(picture.at<cv::Vec3b>(top + 60 * zoom, 140 * zoom)),
            testing::Tone::kGrey);
}

TEST(StagePictureTest, BestViewShowsTheDifferenceToTheScene) {
  // The scene is the view itself, moved by the hypothesis: the difference is 0 everywhere.
  const ReferenceObject object = smallObject(2);
  SceneChannels window = smallScene(64, 64);
  window.range_px = Image<float>(64, 64, 0.0f);
  Hypothesis hypothesis;
  hypothesis.translation_px = {3.0f, -5.0f, 140.0f};
  hypothesis.error = 0.5f;
  for (int v = 0; v < 32; ++v) {
    for (int u = 0; u < 32; ++u) {
      const float range = object.atlas.at(u, v).g;
      if (range > 0.0f) window.range_px.at(u + 16 + 3, v + 16 - 5) = range - 32.0f + 140.0f;
    }
  }
  const ColourScale scale{"", "", -8.0f, 8.0f, false, true};
  const auto rightField = [&](const SceneChannels& scene) {
    const cv::Mat picture = bestViewPicture(object, {scene}, {hypothesis});
    const int zoom = 384 / 64;
    const cv::Mat bar = colourBar({"scene - view", "px", -8.0f, 8.0f, false, true}, 64 * zoom);
    const int left = picture.cols - bar.cols - 12 - 64 * zoom;
    return cv::Mat(picture(cv::Rect(left, picture.rows - 64 * zoom, 64 * zoom, 64 * zoom)));
  };
  const int all = static_cast<int>(object.views[0].area_px) * (384 / 64) * (384 / 64);
  EXPECT_EQ(countOf(rightField(window), colourOf(0.0f, scale)), all);
  for (float& range : window.range_px) {
    if (range > 0.0f) range += 4.0f;
  }
  EXPECT_EQ(countOf(rightField(window), colourOf(4.0f, scale)), all);
}

TEST(PlotTest, BestViewIsCircledWhereItIsSeenFrom) {
  ReferenceObject object = smallObject(2);
  object.views[0].rotation = glm::dmat3(1.0);  // looks along +z: elevation 90
  object.views[1].rotation = rotationFromVector({1.5707963267948966, 0, 0});  // along the horizon
  std::vector<Hypothesis> hypotheses(2);
  hypotheses[0].view = 0;
  hypotheses[0].error = 3.0f;
  hypotheses[1].view = 1;
  hypotheses[1].error = 1.0f;
  const cv::Mat plot = errorOverDirections(object, hypotheses);
  const cv::Vec3b ring(60, 60, 255);
  cv::Point2d sum(0, 0);
  int count = 0;
  for (int y = 0; y < plot.rows; ++y) {
    for (int x = 0; x < plot.cols; ++x) {
      if (plot.at<cv::Vec3b>(y, x) != ring) continue;
      sum += cv::Point2d(x, y);
      ++count;
    }
  }
  ASSERT_GT(count, 10);
  EXPECT_NEAR(sum.y / count, 12 + 180, 3.0) << "elevation 0 lies in the middle of the map";
  const glm::dmat3& r = object.views[1].rotation;
  const double azimuth = std::atan2(r[1][2], r[0][2]);
  EXPECT_NEAR(sum.x / count, 64 + (azimuth / 3.14159265 + 1.0) * 360.0, 3.0);
}

}  // namespace
}  // namespace rangepose::debug
