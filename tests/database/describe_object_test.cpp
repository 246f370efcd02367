// From mesh to views: the scale must let every view fit, or its outline is lost at the tile's
// border.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "database/reference_database.h"
#include "geometry/orientation_grid.h"
#include "stages/reference_host.h"
#include "support/box_mesh.h"
#include "support/shapes.h"

namespace rangepose {
namespace {

using testing::HasSubstr;

Mesh bracket() { return test::meshOf(test::bracketBoxes()); }

std::string messageFor(const Mesh& mesh, int size, std::size_t views) {
  try {
    describeObject(mesh, 1, size, std::vector<glm::dmat3>(views, glm::dmat3(1.0)), {});
  } catch (const Error& error) {
    return error.what();
  }
  return "accepted";
}

TEST(DescribeObjectTest, SizesAndNumbersOutOfRangeAreRefused) {
  for (const int size : {16, 24, 64, 128})
    EXPECT_EQ(messageFor(bracket(), size, 1), "accepted") << size;
  for (const int size : {-64, 0, 8, 15, 60, 63, 136, 256}) {
    EXPECT_THAT(messageFor(bracket(), size, 1), HasSubstr("view size " + std::to_string(size)));
  }
  EXPECT_EQ(messageFor(bracket(), 64, 65536), "accepted");
  EXPECT_THAT(messageFor(bracket(), 64, 0), HasSubstr("number of views 0"));
  EXPECT_THAT(messageFor(bracket(), 64, 65537), HasSubstr("65537"));
  EXPECT_THAT(messageFor(Mesh{}, 64, 1), HasSubstr("no faces"));
}

TEST(DescribeObjectTest, KeepsWhatItWasGiven) {
  const std::vector<glm::dmat3> rotations = uniformRotations(12);
  const ChannelOptions options = channelOptionsFor(32);
  const ReferenceObject object = describeObject(bracket(), 42, 32, rotations, options);
  EXPECT_EQ(object.id, 42);
  EXPECT_EQ(object.size, 32);
  EXPECT_EQ(object.mesh.vertices, bracket().vertices);
  EXPECT_EQ(object.diameter_mm, diameter(bracket()));
  ASSERT_EQ(object.views.size(), 12U);
  for (std::size_t i = 0; i < 12; ++i) EXPECT_EQ(object.views[i].rotation, rotations[i]);
  EXPECT_EQ(channelOptionsOf(object).edt_passes, options.edt_passes);
  EXPECT_EQ(channelOptionsOf(object).image_width_px, options.image_width_px);
}

TEST(DescribeObjectTest, ChannelsFollowThePaper) {
  EXPECT_EQ(channelOptionsFor(64).edt_passes, 7);
  EXPECT_EQ(channelOptionsFor(128).edt_passes, 14);
  for (const int size : {16, 32, 64, 128}) {
    EXPECT_EQ(channelOptionsFor(size).image_width_px, size);
    EXPECT_NO_THROW(channelOptionsFor(size).check());
  }
}

TEST(DescribeObjectTest, NoViewReachesTheBorderOfItsTile) {
  const Mesh meshes[] = {bracket(),
                         test::sphereMesh({500.0, -300.0, 20.0}, 35.0, 60),
                         test::meshOf({{{0, 0, 0}, {200, 2, 2}}}),
                         test::plateMesh(80.0, 50.0),
                         test::meshOf({{{-0.01, -0.01, -0.02}, {0.01, 0.02, 0.03}}})};
  for (const Mesh& mesh : meshes) {
    for (const int size : {16, 32, 64}) {
      ReferenceObject object = describeObject(mesh, 1, size, uniformRotations(120), {});
      EXPECT_DOUBLE_EQ(object.pixel_mm * (size - 4), 2.0 * object.radius_mm) << "pixels are wasted";
      host::renderReferences(object, channelOptionsFor(size), {});
      for (const ReferenceView& view : object.views) {
        if (view.box.empty()) continue;  // a plate seen edge on
        ASSERT_GE(std::min(view.box.x0, view.box.y0), 2) << mesh.name << ", " << size << " px";
        ASSERT_LE(std::max(view.box.x1, view.box.y1), size - 2)
            << mesh.name << ", " << size << " px";
      }
    }
  }
}

}  // namespace
}  // namespace rangepose
