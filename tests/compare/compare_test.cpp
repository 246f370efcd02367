// Two paths on one image, stage by stage.
#include "compare/compare.h"

#include <gmock/gmock.h>

#include "cuda/cuda_path.h"
#include "database/reference_database.h"
#include "geometry/orientation_grid.h"
#include "gles/stage_set_gles.h"
#include "stages/reference_host.h"
#include "support/backends.h"
#include "support/box_mesh.h"
#include "support/shapes.h"

namespace rangepose {
namespace {

using testing::HasSubstr;

/// The host's stages, of which one is bent.
class Bent : public StageSet {
 public:
  explicit Bent(std::string stage) : bent_(std::move(stage)), host_(makeHostStages()) {}

  std::string name() const override { return "bent"; }
  Image<float> resample(const DepthImage& image,
                        const Image<std::uint8_t>& keep,
                        const OrthoCamera& camera) override {
    return bend(host_->resample(image, keep, camera), "resample");
  }
  Image<float> median(const Image<float>& range) override {
    return bend(host_->median(range), "median");
  }
  Image<float> edges(const Image<float>& range_px, float threshold_px) override {
    return bend(host_->edges(range_px, threshold_px), "edges");
  }
  Image<EdtTexel> distanceTexels(const Image<float>& range_px,
                                 const Image<float>& edges,
                                 int passes) override {
    Image<EdtTexel> texels = host_->distanceTexels(range_px, edges, passes);
    if (bent_ == "edt") texels.at(0, 0).site_x += 1.0f;
    return texels;
  }
  Image<float> distance(const Image<float>& range_px,
                        const Image<float>& edges,
                        int passes) override {
    return bend(host_->distance(range_px, edges, passes), "distance");
  }
  Image<std::int32_t> patches(const Image<float>& range_px, const Image<float>& edges) override {
    Image<std::int32_t> labels = host_->patches(range_px, edges);
    if (bent_ == "patches") ++labels.at(0, 0);
    return labels;
  }
  std::vector<ErrorTerms> errorTerms(const ReferenceObject& object,
                                     const SceneChannels& window,
                                     const std::vector<glm::vec3>& translations_px,
                                     const ErrorOptions& options) override {
    std::vector<ErrorTerms> terms = host_->errorTerms(object, window, translations_px, options);
    if (bent_ == "error terms") terms.back().range_weight *= 1.001f;
    return terms;
  }
  std::vector<SimplexState> simplexSteps(const std::vector<SimplexState>& states,
                                         const std::vector<float>& values,
                                         const SimplexOptions& options) override {
    std::vector<SimplexState> next = host_->simplexSteps(states, values, options);
    if (bent_ == "simplex steps") next.front().lowest ^= 1;
    return next;
  }
  Image<SurfaceTexel> renderSurface(const Mesh& mesh,
                                    const Camera& camera,
                                    const Pose& camera_from_object,
                                    const SurfaceWindow& window) override {
    Image<SurfaceTexel> surface = host_->renderSurface(mesh, camera, camera_from_object, window);
    if (bent_ != "surface depth") return surface;
    for (SurfaceTexel& texel : surface) texel.w += texel.w > 0.0f ? 0.2f : 0.0f;
    return surface;
  }
  std::unique_ptr<ResidentScene> prepare(const DepthImage& image,
                                         const Image<std::uint8_t>& keep,
                                         const OrthoCamera& camera,
                                         const PixelBox& region,
                                         const ChannelOptions& options) override {
    std::unique_ptr<ResidentScene> scene = host_->prepare(image, keep, camera, region, options);
    if (bent_ != "prepare") return scene;
    SceneChannels channels = scene->download();
    channels.distance_px.at(0, 0) += 0.01f;
    return host_->upload(channels);
  }
  std::unique_ptr<ResidentScene> upload(const SceneChannels& channels) override {
    return host_->upload(channels);
  }
  Image<std::int32_t> patches(const ResidentScene& scene) override {
    Image<std::int32_t> labels = host_->patches(scene);
    if (bent_ == "scene patches") ++labels.at(0, 0);
    return labels;
  }
  std::vector<Hypothesis> search(const ReferenceObject& object,
                                 const std::vector<const ResidentScene*>& windows,
                                 const std::vector<float>& seed_range_px,
                                 const SearchOptions& options) override {
    std::vector<Hypothesis> all = host_->search(object, windows, seed_range_px, options);
    for (Hypothesis& hypothesis : all) {
      if (bent_ == "search errors") hypothesis.error *= 1.01f;
    }
    if (bent_ == "search winners") all[all.size() - 1].error = 0.0f;
    return all;
  }
  std::unique_ptr<ResidentForeground> foreground(const DepthImage& measured,
                                                 const ForegroundTask& task) override {
    std::unique_ptr<ResidentForeground> found = StageSet::foreground(measured, task);
    // One row of the image.
    if (bent_ == "foreground") std::fill_n(found->on_host.mask.data(), measured.camera.width, 1);
    if (bent_ == "background") found->on_host.noise_mm += 1e-4;
    return found;
  }
  std::vector<IcpResult> align(const ResidentDepth& depth,
                               const std::vector<AlignTask>& tasks) override {
    return moved(StageSet::align(depth, tasks), "alignment");
  }
  std::vector<CheckResult> judge(const ResidentDepth& depth,
                                 const std::vector<JudgeTask>& tasks) override {
    return praised(StageSet::judge(depth, tasks), "verdict");
  }
  std::vector<IcpResult> alignSurfaces(const ResidentDepth& depth,
                                       const std::vector<RenderTask>& tasks) override {
    return moved(StageSet::alignSurfaces(depth, tasks), "surface alignment");
  }
  std::vector<CheckResult> judgeSurfaces(const ResidentDepth& depth,
                                         const std::vector<RenderTask>& tasks) override {
    return praised(StageSet::judgeSurfaces(depth, tasks), "surface verdict");
  }

 private:
  Image<float> bend(Image<float> image, const std::string& stage) const {
    if (bent_ == stage) image.at(image.width() / 2, image.height() / 2) += 0.5f;
    return image;
  }

  std::vector<IcpResult> moved(std::vector<IcpResult> results, const std::string& stage) const {
    if (bent_ != stage) return results;
    for (IcpResult& result : results) result.camera_from_object.translation_mm.x += 1.0;
    return results;
  }
  std::vector<CheckResult> praised(std::vector<CheckResult> results,
                                   const std::string& stage) const {
    if (bent_ != stage) return results;
    for (CheckResult& result : results) result.score += 0.05;
    return results;
  }

  std::string bent_;
  std::unique_ptr<StageSet> host_;
};

/// A bracket on a table.
struct Example {
  ReferenceDatabase database;
  DepthImage depth;

  Example() {
    constexpr int kViews = 200;
    ReferenceObject object = describeObject(
        test::meshOf(test::bracketBoxes()), 1, 64, uniformRotations(kViews), channelOptionsFor(64));
    host::renderReferences(object, channelOptionsFor(64), {});
    depth.camera = test::pinholeCamera(320, 240, 420.0);
    const Pose table = {glm::dmat3(1.0), {0.0, 0.0, 440.0}};
    test::measure(depth, test::plateMesh(600.0, 500.0), table);
    Pose part = {object.views[11].rotation, glm::dvec3(0.0)};
    part.translation_mm = glm::dvec3(12.0, -7.0, 405.0) - part.rotation * object.center_mm;
    test::measure(depth, object.mesh, part);
    database.objects.push_back(std::move(object));
  }
};

const Example& example() {
  static const Example made;
  return made;
}

const StageComparison& stageOf(const std::vector<StageComparison>& stages,
                               const std::string& name) {
  const auto found = std::find_if(stages.begin(), stages.end(), [&](const StageComparison& stage) {
    return stage.stage == name;
  });
  if (found == stages.end()) throw Error("no stage " + name);
  return *found;
}

Comparison compareWith(StageSet& subject) {
  const std::unique_ptr<StageSet> host = makeHostStages();
  return comparePaths(example().depth, std::nullopt, example().database, {}, *host, subject);
}

void expectAllCompared(const Comparison& comparison) {
  for (const auto* stages : {&comparison.isolated, &comparison.chained}) {
    for (const StageComparison& stage : *stages) {
      EXPECT_GT(stage.total, 0) << stage.stage << " compared nothing";
      EXPECT_TRUE(stage.within) << comparisonTable(comparison);
      EXPECT_EQ(stage.path, comparison.subject);
    }
  }
}

TEST(CompareTest, APathEqualsItself) {
  const std::unique_ptr<StageSet> host = makeHostStages();
  const Comparison comparison = compareWith(*host);
  expectAllCompared(comparison);
  EXPECT_EQ(comparison.first_out_of_tolerance, std::nullopt);
  EXPECT_EQ(comparison.subject_work.draws, 0);
  for (const StageComparison& stage : comparison.isolated) {
    EXPECT_EQ(stage.differing, 0) << stage.stage;
    EXPECT_EQ(stage.max_difference, 0.0) << stage.stage;
  }
}

TEST(CompareTest, TheCudaPathIsWithinTolerance) {
  cuda::Path path;
  try {
    path = cuda::openPath();
  } catch (const Unavailable& error) {
    if (test::backendRequired("cuda")) FAIL() << error.what();
    GTEST_SKIP() << error.what();
  }
  const Comparison comparison = compareWith(*path.stages);
  expectAllCompared(comparison);
  EXPECT_EQ(comparison.first_out_of_tolerance, std::nullopt) << comparisonTable(comparison);
  EXPECT_GT(comparison.subject_work.launches, 0);
}

class BentStage : public testing::TestWithParam<std::pair<const char*, const char*>> {};

TEST_P(BentStage, IsNamed) {
  const auto [bent, named] = GetParam();
  Bent subject(bent);
  const Comparison comparison = compareWith(subject);
  ASSERT_TRUE(comparison.first_out_of_tolerance.has_value());
  EXPECT_EQ(*comparison.first_out_of_tolerance, named);
  EXPECT_THAT(comparisonTable(comparison),
              HasSubstr(std::string("first out of tolerance: ") + named));
}

INSTANTIATE_TEST_SUITE_P(AllStages,
                         BentStage,
                         testing::Values(std::pair("foreground", "isolated foreground"),
                                         std::pair("background", "isolated background"),
                                         std::pair("resample", "isolated resample"),
                                         std::pair("median", "isolated median"),
                                         std::pair("edges", "isolated edges"),
                                         std::pair("edt", "isolated edt"),
                                         std::pair("distance", "isolated distance"),
                                         std::pair("patches", "isolated patches"),
                                         std::pair("prepare", "isolated prepare"),
                                         std::pair("error terms", "isolated error terms"),
                                         std::pair("simplex steps", "isolated simplex steps"),
                                         std::pair("search errors", "isolated search errors"),
                                         std::pair("search winners", "isolated search winners"),
                                         std::pair("surface depth", "isolated surface depth"),
                                         std::pair("alignment", "isolated alignment"),
                                         std::pair("verdict", "isolated verdict"),
                                         std::pair("surface alignment",
                                                   "isolated surface alignment"),
                                         std::pair("surface verdict", "isolated surface verdict"),
                                         std::pair("scene patches", "chained scene patches")),
                         [](const auto& test_info) {
                           std::string name = test_info.param.first;
                           std::replace(name.begin(), name.end(), ' ', '_');
                           return name;
                         });

TEST(CompareTest, ASurfaceRenderedTooDeepMovesThePoseOnly) {
  Bent subject("surface depth");
  const Comparison comparison = compareWith(subject);
  EXPECT_TRUE(stageOf(comparison.chained, "rough errors").within);
  EXPECT_FALSE(stageOf(comparison.chained, "pose position").within);
}

TEST(CompareTest, AnImageWithoutPartsIsCompared) {
  DepthImage table;
  table.camera = test::pinholeCamera(160, 120, 210.0);
  test::measure(table, test::plateMesh(900.0, 900.0), {glm::dmat3(1.0), {0.0, 0.0, 440.0}});
  const std::unique_ptr<StageSet> host = makeHostStages();
  Bent subject("nothing");
  const Comparison comparison =
      comparePaths(table, std::nullopt, example().database, {}, *host, subject);
  EXPECT_EQ(comparison.first_out_of_tolerance, std::nullopt);
  EXPECT_THAT(comparisonTable(comparison), HasSubstr("no pose on either path"));
}

TEST(CompareTest, TheTablesColumnsAreAligned) {
  Bent subject("median");
  const std::string table = comparisonTable(compareWith(subject));
  const std::size_t width = table.find('\n');
  std::size_t begin = 0;
  for (int line = 0; line < 15; ++line) {
    const std::size_t end = table.find('\n', begin);
    EXPECT_EQ(end - begin, width) << table.substr(begin, end - begin);
    begin = end + 1;
  }
  EXPECT_THAT(table, HasSubstr("OUT"));
}

using CompareGles = test::GlesFixture;

TEST_F(CompareGles, GlslIsWithinToleranceEverywhere) {
  const std::unique_ptr<StageSet> glsl = gles::makeGlesStages(context());
  const Comparison comparison = compareWith(*glsl);
  EXPECT_EQ(comparison.subject, "glsl");
  EXPECT_GT(comparison.subject_work.draws, 0) << "nothing ran on the device";
  expectAllCompared(comparison);
  EXPECT_EQ(comparison.first_out_of_tolerance, std::nullopt) << comparisonTable(comparison);
  EXPECT_EQ(stageOf(comparison.isolated, "edt").differing, 0);
}

TEST_F(CompareGles, AFaultInAShaderIsNamed) {
  const std::unique_ptr<StageSet> faulty = gles::makeGlesStages(context(), {{"RP_FAULT", "1"}});
  const Comparison comparison = compareWith(*faulty);
  ASSERT_TRUE(comparison.first_out_of_tolerance.has_value());
  EXPECT_EQ(*comparison.first_out_of_tolerance, "isolated edt") << comparisonTable(comparison);
  EXPECT_TRUE(stageOf(comparison.isolated, "edges").within);
}

}  // namespace
}  // namespace rangepose
