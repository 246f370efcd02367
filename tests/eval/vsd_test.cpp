#include "eval/vsd.h"

#include <gmock/gmock.h>

#include <numbers>

#include "core/error.h"
#include "eval/eval_support.h"
#include "eval/grade_image.h"
#include "support/box_mesh.h"
#include "support/shapes.h"

namespace rangepose {
namespace {

using testing::Each;
using testing::ElementsAre;

Pose at(double x, double y, double z) {
  Pose pose;
  pose.translation_mm = {x, y, z};
  return pose;
}

/// A row of pixels: what is measured, and what two posed models would show there [mm].
struct Row {
  Image<float> measured;
  PosedModel estimate;
  PosedModel truth;
};

Row rowOf(const std::vector<float>& measured,
          const std::vector<float>& estimate,
          const std::vector<float>& truth) {
  const int width = static_cast<int>(measured.size());
  const auto image = [width](const std::vector<float>& values) {
    Image<float> pixels(width, 1);
    std::copy(values.begin(), values.end(), pixels.begin());
    return pixels;
  };
  const PixelBox box{0, 0, width, 1};
  return {image(measured), {box, image(estimate)}, {box, image(truth)}};
}

std::vector<double> errorsOf(const Row& row, const std::vector<double>& taus) {
  VsdOptions options;
  options.taus = taus;
  return vsdErrors(row.measured, row.estimate, row.truth, 100.0, options);
}

TEST(Vsd, PixelByPixelByHand) {
  // Both seen and 3 mm apart; both seen and 30 mm apart; only the estimate; only the truth;
  // neither.
  const Row row = rowOf({500, 500, 500, 500, 500}, {503, 470, 500, 0, 0}, {500, 500, 0, 500, 0});
  EXPECT_THAT(errorsOf(row, {0.02, 0.05, 0.3, 0.31}),
              ElementsAre(4.0 / 4.0, 3.0 / 4.0, 3.0 / 4.0, 2.0 / 4.0));
}

TEST(Vsd, SurfaceBehindTheDataIsNotSeenUnlessTheTruthIs) {
  // 16 mm behind the data: hidden, for both. At 15 mm still seen.
  EXPECT_THAT(errorsOf(rowOf({500, 500}, {516, 500}, {516, 500}), {0.05}), ElementsAre(0.0));
  EXPECT_THAT(errorsOf(rowOf({500}, {516}, {516}), {0.05}), ElementsAre(1.0)) << "none is seen";
  EXPECT_THAT(errorsOf(rowOf({500, 500}, {0, 500}, {515, 500}), {0.05}), ElementsAre(0.5));
  EXPECT_THAT(errorsOf(rowOf({500, 500}, {0, 500}, {516, 500}), {0.05}), ElementsAre(0.0));
  // The estimate far behind a truth that is seen counts as seen there, and as wrong.
  EXPECT_THAT(errorsOf(rowOf({500}, {590}, {500}), {0.05, 0.95}), ElementsAre(1.0, 0.0));
}

TEST(Vsd, WhatWasNotMeasuredCountsAsSeen) {
  EXPECT_THAT(errorsOf(rowOf({0, 0}, {500, 0}, {500, 500}), {0.05}), ElementsAre(0.5));
}

/// A bracket 600 mm away, as measured.
class VsdScene : public testing::TestWithParam<bool> {
 protected:
  VsdScene() {
    image_.camera =
        GetParam() ? test::parallelCamera(200, 160, 0.5) : test::pinholeCamera(200, 160, 900.0);
    test::measure(image_, mesh_, truth_);
    measured_ = distancesOf(image_);
  }
  std::vector<double> errors(const Pose& estimate) const {
    return vsdErrors(measured_,
                     renderPosed(mesh_, image_.camera, estimate),
                     renderPosed(mesh_, image_.camera, truth_),
                     diameter(mesh_));
  }
  const Mesh mesh_ = test::meshOf(test::bracketBoxes());
  const Pose truth_{rotationFromVector({0.5, 0.3, 0.2}), {-15.0, -5.0, 600.0}};
  DepthImage image_;
  Image<float> measured_;
};

TEST_P(VsdScene, TruthAsEstimateIsExactlyZero) {
  EXPECT_THAT(errors(truth_), Each(0.0));
  EXPECT_EQ(errors(truth_).size(), 10u);
}

TEST_P(VsdScene, GrowsWithTheShiftAndReachesOneBeside) {
  double last = 0.0;
  for (const double shift : {2.0, 6.0, 15.0}) {
    const double now = errors(at(shift, 0.0, 0.0) * truth_).front();
    EXPECT_GT(now, last);
    last = now;
  }
  EXPECT_THAT(errors(at(1000.0, 0.0, 0.0) * truth_), Each(1.0)) << "out of the image";
  EXPECT_THAT(errors(at(-50.0, 30.0, -100.0) * truth_).front(), testing::DoubleNear(1.0, 1e-12));
}

TEST_P(VsdScene, DepthErrorBelowTauCostsNothingInside) {
  // 5 % of the diameter is 2.7 mm: 2 mm nearer changes only the outline.
  const std::vector<double> nearer = errors(at(0.0, 0.0, -2.0) * truth_);
  EXPECT_LT(nearer.front(), 0.12);
  const std::vector<double> farther = errors(at(0.0, 0.0, -8.0) * truth_);
  EXPECT_GT(farther[1], 0.95) << "8 mm are more than 10 %";
  EXPECT_LT(farther[3], 0.2) << "and less than 20 %";
}

INSTANTIATE_TEST_SUITE_P(Cameras, VsdScene, testing::Values(false, true), [](const auto& test) {
  return test.param ? "Orthographic" : "Pinhole";
});

TEST(Vsd, DistanceIsAlongTheRay) {
  DepthImage image;
  image.camera = test::pinholeCamera(3, 1, 1.0);
  image.depth_mm = Image<float>(3, 1, 100.0f);
  image.depth_mm.at(0, 0) = 0.0f;
  const Image<float> distance = distancesOf(image);
  EXPECT_FLOAT_EQ(distance.at(1, 0), 100.0f);
  EXPECT_FLOAT_EQ(distance.at(2, 0), 100.0f * std::sqrt(2.0f));
  EXPECT_EQ(distance.at(0, 0), 0.0f);
}

TEST(Vsd, OptionsAreChecked) {
  VsdOptions options;
  options.delta_mm = -1.0;
  EXPECT_THROW(options.check(), Error);
  options = {};
  options.taus.clear();
  EXPECT_THROW(options.check(), Error);
  options.taus = {0.0};
  EXPECT_THROW(options.check(), Error);
}

/// How differently a part looks in two poses, the first of which is measured.
double unlike(const Mesh& part, const Pose& truth, const Pose& estimate) {
  Camera camera;
  camera.width = 160;
  camera.height = 120;
  camera.fx = camera.fy = 300.0;
  camera.cx = 79.5;
  camera.cy = 59.5;
  const ErrorModel model(part, {});
  const PosedModel seen = renderPosed(part, camera, truth);
  Image<float> measured(camera.width, camera.height, 0.0f);
  for (int v = seen.box.y0; v < seen.box.y1; ++v) {
    for (int u = seen.box.x0; u < seen.box.x1; ++u)
      measured.at(u, v) = seen.distance_mm.at(u - seen.box.x0, v - seen.box.y0);
  }
  ImageGrading grading;
  grading.estimates = {estimate};
  grading.truths = {truth};
  fillErrors(grading, model, camera, measured, {});
  EXPECT_GT(grading.errors.mssd.at(0, 0), 0.1) << "a pose that is right anyway shows nothing";
  return grading.errors.unlike.at(0, 0);
}

TEST(Unlike, WhatLiesOnTheFarSideIsNotSeen) {
  // A plate with a knob at one end, on the far side or on the near one.
  const Mesh plate = test::meshOf(
      {{{-30.0, -20.0, 0.0}, {30.0, 20.0, 4.0}}, {{16.0, -6.0, 4.0}, {26.0, 6.0, 12.0}}});
  const Pose far_side = at(0.0, 0.0, 300.0);
  const Pose half_turn{rotationFromVector({0.0, 0.0, std::numbers::pi}), {0.0, 0.0, 0.0}};
  EXPECT_LT(unlike(plate, far_side, far_side * half_turn), 0.001);
  const Pose near_side =
      far_side * Pose{rotationFromVector({0.0, std::numbers::pi, 0.0}), {0.0, 0.0, 0.0}};
  EXPECT_GT(unlike(plate, near_side, near_side * half_turn), 0.02)
      << "the knob, some 5 % of what is seen, is in plain sight";
}

}  // namespace
}  // namespace rangepose
