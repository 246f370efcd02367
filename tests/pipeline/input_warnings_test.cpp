// A bin box in metres, or some millimetres off, finds nothing: without a word of it the user looks
// for the reason in the part.
#include "pipeline/input_warnings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "geometry/orientation_grid.h"
#include "support/box_mesh.h"
#include "support/shapes.h"

namespace rangepose {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr double kFloorMm = 600.0;

/// A bin's floor that fills the image, and a box over it. The part's diameter is 100 mm.
class BinWarningsTest : public testing::Test {
 protected:
  BinWarningsTest() {
    const Mesh cube = test::meshOf({{{0, 0, 0}, {60, 80, 0.1}}});
    database_.objects = {describeObject(cube, 1, 64, uniformRotations(1), channelOptionsFor(64))};
    image_.camera = test::pinholeCamera(320, 240, 500.0);
    image_.depth_mm = Image<float>(320, 240, static_cast<float>(kFloorMm));
  }

  /// With its floor so much nearer to the camera than the one that is seen.
  std::vector<std::string> warnings(double raised_mm, const glm::dvec3& inner_size_mm) const {
    BinBox bin;
    bin.camera_from_bin = {rotationFromVector({std::numbers::pi, 0.0, 0.0}),
                           {0.0, 0.0, kFloorMm - raised_mm}};
    bin.inner_size_mm = inner_size_mm;
    return binWarnings(image_, bin, database_);
  }

  ReferenceDatabase database_;
  DepthImage image_;
};

TEST_F(BinWarningsTest, NoneForABoxThatFitsOrNearlyDoes) {
  for (const double raised_mm : {-20.0, 0.0, 4.0})
    EXPECT_THAT(warnings(raised_mm, {200, 150, 100}), IsEmpty()) << raised_mm;
}

TEST_F(BinWarningsTest, AFloorOverPartOfTheDataIsNamedWithItsHeight) {
  // A quarter of what is seen lies 30 mm higher, on the floor as it is given.
  for (int v = 0; v < 120; ++v) {
    for (int u = 0; u < 160; ++u) image_.depth_mm.at(u, v) = static_cast<float>(kFloorMm - 30.0);
  }
  EXPECT_THAT(warnings(30.0, {1000, 1000, 100}),
              ElementsAre(AllOf(HasSubstr("75 %"), HasSubstr("30 mm"), HasSubstr("cam_t_bin2c"))));
}

TEST_F(BinWarningsTest, ABoxWithoutDataIsNamed) {
  const std::string expected = "no measured pixel lies in the bin";
  EXPECT_THAT(warnings(30.0, {200, 150, 100}), ElementsAre(HasSubstr(expected)));
  EXPECT_THAT(warnings(0.0, {0.2, 0.15, 0.1}), ElementsAre(HasSubstr(expected))) << "in metres";
}

}  // namespace
}  // namespace rangepose
