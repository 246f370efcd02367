// From a depth image to poses: contracts of the whole.
#include "pipeline/estimate.h"

#include <gmock/gmock.h>

#include <cmath>

#include "core/parallel.h"
#include "database/reference_database.h"
#include "geometry/orientation_grid.h"
#include "sim/heap.h"
#include "sim/scanner.h"
#include "stages/reference_host.h"
#include "support/box_mesh.h"
#include "support/shapes.h"

namespace rangepose {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

constexpr int kViews = 400;

Mesh bracket(double scale) {
  Mesh mesh = test::meshOf(test::bracketBoxes());
  for (glm::vec3& vertex : mesh.vertices) vertex *= static_cast<float>(scale);
  mesh.name = "bracket";
  return mesh;
}

ReferenceDatabase databaseOf(const Mesh& mesh, int views) {
  ReferenceDatabase database;
  database.objects.push_back(
      describeObject(mesh, 1, 64, uniformRotations(views), channelOptionsFor(64)));
  host::renderReferences(database.objects.front(), channelOptionsFor(64), {});
  return database;
}

const ReferenceDatabase& brackets() {
  static const ReferenceDatabase database = databaseOf(bracket(2.0), kViews);
  return database;
}

const ReferenceObject& part() { return brackets().objects.front(); }

Estimate estimated(const DepthImage& image, const EstimateOptions& options = {}) {
  const std::unique_ptr<StageSet> stages = makeHostStages();
  return estimatePoses(image, std::nullopt, brackets(), options, *stages);
}

/// The part with its centre at `center`, turned in no way that a view is.
Pose partAt(const glm::dvec3& center) {
  Pose pose;
  pose.rotation = rotationFromVector({-0.7, 1.9, 0.4});
  pose.translation_mm = center - pose.rotation * part().center_mm;
  return pose;
}

DepthImage imageOf(const Camera& camera) {
  return {camera, Image<float>(camera.width, camera.height, 0.0f)};
}

DepthImage tableImage() {
  DepthImage image = imageOf(test::pinholeCamera(320, 240, 300.0));
  test::measure(image, test::plateMesh(900.0, 900.0), {glm::dmat3(1.0), {0.0, 0.0, 560.0}});
  return image;
}

DepthImage partOnTable(const Pose& pose) {
  DepthImage image = tableImage();
  test::measure(image, part().mesh, pose);
  return image;
}

/// Mean distance of the vertices in two poses, as a share of the diameter.
double distanceBetween(const Pose& a, const Pose& b) {
  double sum = 0.0;
  for (const glm::vec3& vertex : part().mesh.vertices)
    sum += glm::distance(a * glm::dvec3(vertex), b * glm::dvec3(vertex));
  return sum / static_cast<double>(part().mesh.vertices.size()) / part().diameter_mm;
}

std::string errorOf(const DepthImage& image,
                    const ReferenceDatabase& database,
                    const EstimateOptions& options) {
  const std::unique_ptr<StageSet> stages = makeHostStages();
  try {
    static_cast<void>(estimatePoses(image, std::nullopt, database, options, *stages));
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(EstimateTest, PartOnATableIsFound) {
  const Pose truth = partAt({20.0, -15.0, 480.0});
  const Estimate estimate = estimated(partOnTable(truth));
  ASSERT_EQ(estimate.poses.size(), 1u);
  const PoseEstimate& found = estimate.poses.front();
  EXPECT_LT(distanceBetween(found.pose, truth), 0.02);
  EXPECT_EQ(found.object, 0);
  EXPECT_GT(found.check.score, 0.8);
  EXPECT_LE(found.check.score, 1.0);
  EXPECT_EQ(estimate.background.size(), 1u);
  EXPECT_THAT(estimate.warnings, IsEmpty());
  EXPECT_FALSE(estimate.times.empty());
}

TEST(EstimateTest, ImageWithoutMeasurementIsAnError) {
  EXPECT_THAT(errorOf(imageOf(test::pinholeCamera(80, 60, 70.0)), brackets(), {}),
              HasSubstr("no measured pixel"));
}

TEST(EstimateTest, ImageOfAnotherSizeThanTheCameraIsAnError) {
  DepthImage image = tableImage();
  image.camera.width = 321;
  EXPECT_THAT(errorOf(image, brackets(), {}), HasSubstr("differ in size"));
}

TEST(EstimateTest, BadCameraIsAnError) {
  DepthImage image = tableImage();
  image.camera.fx = 0.0;
  EXPECT_THAT(errorOf(image, brackets(), {}), testing::Not(HasSubstr("no error")));
}

TEST(EstimateTest, TolerancesGoByTheErrorThatTheCameraStates) {
  DepthImage image = tableImage();
  EXPECT_EQ(estimated(image).noise_mm, estimated(image).sensor.error_mm);
  image.camera.error_mm = 1.25;
  EXPECT_EQ(estimated(image).noise_mm, 1.25) << "a calibrated sensor would be judged by a guess";
}

TEST(EstimateTest, EmptyDatabaseIsAnError) {
  EXPECT_THAT(errorOf(tableImage(), {}, {}), HasSubstr("no object"));
}

TEST(EstimateTest, BadOptionsAreNamed) {
  const auto with = [](const auto& change) {
    EstimateOptions options;
    change(options);
    return errorOf(tableImage(), brackets(), options);
  };
  EXPECT_THAT(with([](EstimateOptions& o) { o.starts = -1; }), HasSubstr("starts"));
  EXPECT_THAT(with([](EstimateOptions& o) { o.kept_per_start = -1; }), HasSubstr("kept_per_start"));
  EXPECT_THAT(with([](EstimateOptions& o) { o.verified = -1; }), HasSubstr("verified"));
  EXPECT_THAT(with([](EstimateOptions& o) { o.max_poses = 0; }), HasSubstr("max_poses"));
  EXPECT_THAT(with([](EstimateOptions& o) { o.search.simplex.step_px = 0.0f; }),
              HasSubstr("step_px"));
  EXPECT_THAT(with([](EstimateOptions& o) { o.search.error.lambda = -1.0f; }), HasSubstr("lambda"));
}

TEST(EstimateTest, BareTableGivesNoPose) { EXPECT_THAT(estimated(tableImage()).poses, IsEmpty()); }

TEST(EstimateTest, PosesBelowTheLowestScoreAreNotReported) {
  EstimateOptions options;
  options.min_score = 1.0;
  EXPECT_THAT(estimated(partOnTable(partAt({0.0, 0.0, 480.0})), options).poses, IsEmpty());
}

TEST(EstimateTest, PartOfTheWrongUnitGivesAWarning) {
  const ReferenceDatabase tiny = databaseOf(bracket(0.002), 12);
  const std::unique_ptr<StageSet> stages = makeHostStages();
  const DepthImage image = partOnTable(partAt({0.0, 0.0, 480.0}));
  const Estimate estimate = estimatePoses(image, std::nullopt, tiny, {}, *stages);
  ASSERT_EQ(estimate.warnings.size(), 1u);
  EXPECT_THAT(estimate.warnings[0], HasSubstr("bracket"));
  EXPECT_THAT(estimate.warnings[0], HasSubstr("--unit"));
  const ReferenceDatabase huge = databaseOf(bracket(2000.0), 12);
  EXPECT_EQ(estimatePoses(image, std::nullopt, huge, {}, *stages).warnings.size(), 1u);
}

void expectSamePoses(const Estimate& a, const Estimate& b) {
  ASSERT_EQ(a.poses.size(), b.poses.size());
  EXPECT_EQ(a.noise_mm, b.noise_mm);
  for (std::size_t i = 0; i < a.poses.size(); ++i) {
    const PoseEstimate& x = a.poses[i];
    const PoseEstimate& y = b.poses[i];
    EXPECT_TRUE(x.pose.rotation == y.pose.rotation);
    EXPECT_TRUE(x.pose.translation_mm == y.pose.translation_mm);
    EXPECT_TRUE(x.rough.rotation == y.rough.rotation);
    EXPECT_TRUE(x.rough.translation_mm == y.rough.translation_mm);
    EXPECT_EQ(x.rough_error, y.rough_error);
    EXPECT_EQ(x.view, y.view);
    EXPECT_EQ(x.check.score, y.check.score);
  }
}

struct HeapScene {
  std::vector<PlacedPart> heap;
  Scan scan;

  HeapScene() {
    HeapOptions heap_options;
    heap_options.count = 4;
    heap_options.seed = 3;
    const std::vector<Mesh> meshes = {bracket(2.0)};
    heap = makeHeap(meshes, heap_options);
    ScannerOptions scanner;
    scanner.sensor = sensorModel("structured-light");
    scan = scanHeap(meshes, heap, scanner);
  }
};

const HeapScene& heapScene() {
  static const HeapScene scene;
  return scene;
}

EstimateOptions upTo(int poses) {
  EstimateOptions options;
  options.max_poses = poses;
  return options;
}

TEST(EstimateTest, SameBitsWithAnyNumberOfThreads) {
  setThreadCount(1);
  const Estimate alone = estimated(heapScene().scan.image, upTo(2));
  setThreadCount(0);
  const Estimate together = estimated(heapScene().scan.image, upTo(2));
  const Estimate again = estimated(heapScene().scan.image, upTo(2));
  EXPECT_FALSE(alone.poses.empty());
  expectSamePoses(alone, together);
  expectSamePoses(together, again);
}

TEST(EstimateTest, PosesOfAHeapAreDistinct) {
  const Estimate estimate = estimated(heapScene().scan.image, upTo(4));
  ASSERT_GE(estimate.poses.size(), 3u);
  ASSERT_LE(estimate.poses.size(), 4u);
  int right = 0;
  for (std::size_t i = 0; i < estimate.poses.size(); ++i) {
    const Pose& pose = estimate.poses[i].pose;
    for (std::size_t j = 0; j < i; ++j) {
      EXPECT_GT(distanceBetween(pose, estimate.poses[j].pose), 0.2) << i << " and " << j;
      EXPECT_GE(estimate.poses[j].confidence, estimate.poses[i].confidence) << "best first";
    }
    for (const PartTruth& truth : heapScene().scan.truth)
      right += distanceBetween(pose, truth.camera_from_object) < 0.03 ? 1 : 0;
  }
  EXPECT_GE(right, 3);
}

TEST(EstimateTest, ParallelRaysWork) {
  DepthImage image = imageOf(test::parallelCamera(320, 240, 0.9));
  const Pose truth = partAt({35.0, -20.0, 300.0});
  test::measure(image, test::plateMesh(600.0, 600.0), {glm::dmat3(1.0), {0.0, 0.0, 380.0}});
  test::measure(image, part().mesh, truth);
  const Estimate estimate = estimated(image);
  ASSERT_EQ(estimate.poses.size(), 1u);
  EXPECT_LT(distanceBetween(estimate.poses.front().pose, truth), 0.02);
}

TEST(EstimateTest, PartFarOffTheAxisIsFound) {
  // Half of the image spans 50 degrees; the part is 45 degrees off to one side, then to the other.
  for (const glm::dvec3& center :
       {glm::dvec3(400.0, 0.0, 400.0), glm::dvec3(-280.0, 280.0, 400.0)}) {
    DepthImage image = imageOf(test::pinholeCamera(800, 800, 335.0));
    const Pose truth = partAt(center);
    test::measure(image, test::plateMesh(1800.0, 1800.0), {glm::dmat3(1.0), {0.0, 0.0, 480.0}});
    test::measure(image, part().mesh, truth);
    const Estimate estimate = estimated(image);
    ASSERT_EQ(estimate.poses.size(), 1u);
    EXPECT_LT(distanceBetween(estimate.poses.front().pose, truth), 0.02);
  }
}

TEST(EstimateTest, TraceHoldsWhatHappened) {
  const DepthImage image = partOnTable(partAt({20.0, -15.0, 480.0}));
  const std::unique_ptr<StageSet> stages = makeHostStages();
  EstimateTrace trace;
  const Estimate with = estimatePoses(image, std::nullopt, brackets(), {}, *stages, &trace);
  expectSamePoses(with, estimated(image));
  ASSERT_EQ(trace.objects.size(), 1u);
  const ObjectTrace& object = trace.objects.front();
  ASSERT_FALSE(object.seeds.empty());
  EXPECT_EQ(object.windows.size(), object.seeds.size());
  EXPECT_EQ(object.window_regions.size(), object.seeds.size());
  EXPECT_EQ(object.hypotheses.size(), object.seeds.size() * kViews);
  EXPECT_EQ(object.labels.width(), object.scene.range_px.width());
  ASSERT_FALSE(trace.verified.empty());
  // What was chosen is brought to rest afterwards.
  EXPECT_LT(distanceBetween(trace.verified.front().pose, with.poses.front().pose), 0.01);
}

TEST(EstimateTest, BoxLimitsWhatIsSearched) {
  DepthImage image = tableImage();
  const Pose left = partAt({-110.0, 0.0, 480.0});
  const Pose right = partAt({110.0, 0.0, 470.0});
  test::measure(image, part().mesh, left);
  test::measure(image, part().mesh, right);
  BinBox bin;
  bin.camera_from_bin.rotation = rotationFromVector({std::acos(-1.0), 0.0, 0.0});
  bin.camera_from_bin.translation_mm = {-110.0, 0.0, 560.0};
  bin.inner_size_mm = {180.0, 300.0, 150.0};
  const std::unique_ptr<StageSet> stages = makeHostStages();
  const Estimate estimate = estimatePoses(image, bin, brackets(), upTo(2), *stages);
  ASSERT_EQ(estimate.poses.size(), 1u);
  EXPECT_LT(distanceBetween(estimate.poses.front().pose, left), 0.02);
}

}  // namespace
}  // namespace rangepose
