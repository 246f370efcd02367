// Two paths on one image, stage by stage.
#include "compare/compare.h"

#include <gmock/gmock.h>

#include "cuda/cuda_path.h"
#include "database/reference_database.h"
#include "geometry/orientation_grid.h"
#include "gles/stage_set_gles.h"
#include "stages/reference_host.h"
#include "stages/refine_host.h"
#include "support/backends.h"
#include "support/box_mesh.h"
#include "support/shapes.h"

namespace rangepose {
namespace {

using testing::HasSubstr;

/// Which of the host's stages is bent, and how.
struct Fault {
  std::string stage;

  Image<float> bend(Image<float> image, const std::string& of) const {
    if (stage == of) image.at(image.width() / 2, image.height() / 2) += 0.5f;
    return image;
  }
  Image<std::int32_t> relabel(Image<std::int32_t> labels, const std::string& of) const {
    if (stage == of) ++labels.at(0, 0);
    return labels;
  }
  std::vector<IcpResult> moved(std::vector<IcpResult> results, const std::string& of) const {
    if (stage != of) return results;
    for (IcpResult& result : results) result.camera_from_object.translation_mm.x += 1.0;
    return results;
  }
  std::vector<CheckResult> praised(std::vector<CheckResult> results, const std::string& of) const {
    if (stage != of) return results;
    for (CheckResult& result : results) result.score += 0.05;
    return results;
  }
};

struct BentForeground : ForegroundStage {
  BentForeground(const Fault& its_fault, ForegroundStage& host) : fault(its_fault), own(host) {}
  std::unique_ptr<ResidentDepth> upload(const DepthImage& depth,
                                        const Image<std::uint8_t>& keep) override {
    return own.upload(depth, keep);
  }
  std::unique_ptr<ResidentForeground> find(const DepthImage& measured,
                                           const ForegroundTask& task) override {
    std::unique_ptr<ResidentForeground> found = own.find(measured, task);
    // One row of the image.
    if (fault.stage == "foreground")
      std::fill_n(found->on_host.mask.data(), measured.camera.width, 1);
    if (fault.stage == "background") found->on_host.noise_mm += 1e-4;
    return found;
  }
  LateralExtent extent(const ResidentDepth& depth) override { return own.extent(depth); }
  const Fault& fault;
  ForegroundStage& own;
};

struct BentScenes : SceneStage {
  BentScenes(const Fault& its_fault, SceneStage& host) : fault(its_fault), own(host) {}
  ResidentScenes prepare(const ResidentDepth& depth,
                         const std::vector<WindowTask>& windows,
                         const ChannelOptions& options) override {
    ResidentScenes scenes = own.prepare(depth, windows, options);
    if (fault.stage != "prepare") return scenes;
    for (auto& scene : scenes) {
      SceneChannels channels = scene->download();
      channels.distance_px.at(0, 0) += 0.01f;
      scene = own.upload(channels);
    }
    return scenes;
  }
  std::unique_ptr<ResidentScene> upload(const SceneChannels& channels) override {
    return own.upload(channels);
  }
  Image<std::int32_t> patches(const ResidentScene& scene) override {
    return fault.relabel(own.patches(scene), "scene patches");
  }
  const Fault& fault;
  SceneStage& own;
};

struct BentSearch : SearchStage {
  BentSearch(const Fault& its_fault, SearchStage& host) : fault(its_fault), own(host) {}
  std::vector<Hypothesis> search(const ReferenceObject& object,
                                 const std::vector<const ResidentScene*>& windows,
                                 const std::vector<float>& seed_range_px,
                                 const SearchOptions& options) override {
    std::vector<Hypothesis> all = own.search(object, windows, seed_range_px, options);
    for (Hypothesis& hypothesis : all) {
      if (fault.stage == "search errors") hypothesis.error *= 1.01f;
    }
    if (fault.stage == "search winners") all[all.size() - 1].error = 0.0f;
    return all;
  }
  const Fault& fault;
  SearchStage& own;
};

struct BentRefinement : RefineStage {
  BentRefinement(const Fault& its_fault, RefineStage& host) : fault(its_fault), own(host) {}
  std::vector<IcpResult> align(const ResidentDepth& depth,
                               const std::vector<AlignTask>& tasks) override {
    return fault.moved(own.align(depth, tasks), "alignment");
  }
  std::vector<CheckResult> judge(const ResidentDepth& depth,
                                 const std::vector<JudgeTask>& tasks) override {
    return fault.praised(own.judge(depth, tasks), "verdict");
  }
  std::vector<IcpResult> alignSurfaces(const ResidentDepth& depth,
                                       const std::vector<RenderTask>& tasks) override {
    return fault.moved(own.alignSurfaces(depth, tasks), "surface alignment");
  }
  std::vector<CheckResult> judgeSurfaces(const ResidentDepth& depth,
                                         const std::vector<RenderTask>& tasks) override {
    return fault.praised(own.judgeSurfaces(depth, tasks), "surface verdict");
  }
  const Fault& fault;
  RefineStage& own;
};

struct BentProbe : StageProbe {
  BentProbe(const Fault& its_fault, StageProbe& host) : fault(its_fault), own(host) {}
  Image<float> resample(const DepthImage& image,
                        const Image<std::uint8_t>& keep,
                        const OrthoCamera& camera) override {
    return fault.bend(own.resample(image, keep, camera), "resample");
  }
  Image<float> median(const Image<float>& range) override {
    return fault.bend(own.median(range), "median");
  }
  Image<float> edges(const Image<float>& range_px, float threshold_px) override {
    return fault.bend(own.edges(range_px, threshold_px), "edges");
  }
  Image<EdtTexel> distanceTexels(const Image<float>& range_px,
                                 const Image<float>& edges,
                                 int passes) override {
    Image<EdtTexel> texels = own.distanceTexels(range_px, edges, passes);
    if (fault.stage == "edt") texels.at(0, 0).site_x += 1.0f;
    return texels;
  }
  Image<float> distance(const Image<float>& range_px,
                        const Image<float>& edges,
                        int passes) override {
    return fault.bend(own.distance(range_px, edges, passes), "distance");
  }
  Image<std::int32_t> patches(const Image<float>& range_px, const Image<float>& edges) override {
    return fault.relabel(own.patches(range_px, edges), "patches");
  }
  std::vector<ErrorTerms> errorTerms(const ReferenceObject& object,
                                     const SceneChannels& window,
                                     const std::vector<glm::vec3>& translations_px,
                                     const ErrorOptions& options) override {
    std::vector<ErrorTerms> terms = own.errorTerms(object, window, translations_px, options);
    if (fault.stage == "error terms") terms.back().range_weight *= 1.001f;
    return terms;
  }
  std::vector<SimplexState> simplexSteps(const std::vector<SimplexState>& states,
                                         const std::vector<float>& values,
                                         const SimplexOptions& options) override {
    std::vector<SimplexState> next = own.simplexSteps(states, values, options);
    if (fault.stage == "simplex steps") next.front().lowest ^= 1;
    return next;
  }
  Image<SurfaceTexel> renderSurface(const Mesh& mesh,
                                    const Camera& camera,
                                    const Pose& camera_from_object,
                                    const SurfaceWindow& window) override {
    Image<SurfaceTexel> surface = own.renderSurface(mesh, camera, camera_from_object, window);
    if (fault.stage != "surface depth") return surface;
    for (SurfaceTexel& texel : surface) texel.w += texel.w > 0.0f ? 0.2f : 0.0f;
    return surface;
  }
  const Fault& fault;
  StageProbe& own;
};

/// The host's path, of which one stage is bent.
struct BentPath {
  explicit BentPath(const std::string& stage) : fault{stage}, host(makeHostStages()) {}

  Fault fault;
  std::unique_ptr<StageSet> host;
  BentForeground foreground{fault, *host->foreground};
  BentScenes scenes{fault, *host->scenes};
  BentSearch search{fault, *host->search};
  BentProbe probe{fault, *host->probe};
  RefineOnHost on_host{probe, true};  // with surfaces that may be bent
  BentRefinement refine{fault, on_host};
};

std::unique_ptr<StageSet> bentStages(const std::string& stage) {
  return stageSetOf("bent", "", std::make_shared<BentPath>(stage));
}

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
  const std::unique_ptr<StageSet> subject = bentStages(bent);
  const Comparison comparison = compareWith(*subject);
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
  const std::unique_ptr<StageSet> subject = bentStages("surface depth");
  const Comparison comparison = compareWith(*subject);
  EXPECT_TRUE(stageOf(comparison.chained, "rough errors").within);
  EXPECT_FALSE(stageOf(comparison.chained, "pose position").within);
}

TEST(CompareTest, AnImageWithoutPartsIsCompared) {
  DepthImage table;
  table.camera = test::pinholeCamera(160, 120, 210.0);
  test::measure(table, test::plateMesh(900.0, 900.0), {glm::dmat3(1.0), {0.0, 0.0, 440.0}});
  const std::unique_ptr<StageSet> host = makeHostStages();
  const std::unique_ptr<StageSet> subject = bentStages("nothing");
  const Comparison comparison =
      comparePaths(table, std::nullopt, example().database, {}, *host, *subject);
  EXPECT_EQ(comparison.first_out_of_tolerance, std::nullopt);
  EXPECT_THAT(comparisonTable(comparison), HasSubstr("no pose on either path"));
}

TEST(CompareTest, TheTablesColumnsAreAligned) {
  const std::unique_ptr<StageSet> subject = bentStages("median");
  const std::string table = comparisonTable(compareWith(*subject));
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
