// Surfaces drawn into parts of one target.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "gles/surface_gles.h"
#include "support/backends.h"
#include "support/box_mesh.h"
#include "support/tolerances.h"

namespace rangepose::gles {
namespace {

using SurfaceTilesTest = test::GlesFixture;

constexpr int kTile = 96;
constexpr float kUntouched = -7.0f;

Camera camera() {
  Camera result;
  result.width = 320;
  result.height = 240;
  result.fx = result.fy = 420.0;
  result.cx = 160.0;
  result.cy = 120.0;
  return result;
}

TEST_F(SurfaceTilesTest, EachIsWhatItIsAlone) {
  Device device(context());
  const Mesh mesh = test::meshOf(test::bracketBoxes());
  const MeshBuffers buffers(mesh);
  const Sphere sphere = boundingSphere(mesh);
  Canvas tiles(Format::kRgba32f, 2 * kTile, kTile);
  const Texture depth(Format::kDepth32f, 2 * kTile, kTile);
  const Framebuffer target(tiles.texture, &depth);
  target.clear(glm::vec4(kUntouched));
  target.clearDepth();
  std::vector<Pose> poses;
  std::vector<SurfaceWindow> windows;
  for (int i = 0; i < 2; ++i) {
    Pose pose;
    pose.rotation = rotationFromVector({0.4 + i, -0.3, 0.8 * i});
    pose.translation_mm = glm::dvec3(10.0 * i, -5.0, 420.0) - pose.rotation * sphere.center_mm;
    poses.push_back(pose);
    windows.push_back(
        windowAround(camera(), pose * sphere.center_mm, sphere.radius_mm, kTile - 10 * i));
    const PixelBox box{i * kTile,
                       0,
                       i * kTile + windows[static_cast<std::size_t>(i)].width,
                       windows[static_cast<std::size_t>(i)].height};
    renderSurface(
        device, target, box, mesh, buffers, camera(), pose, windows[static_cast<std::size_t>(i)]);
  }
  const Image<glm::vec4> all = downloadVectors(tiles.texture);
  for (int i = 0; i < 2; ++i) {
    const Image<glm::vec4> alone =
        downloadVectors(renderSurface(device,
                                      mesh,
                                      buffers,
                                      camera(),
                                      poses[static_cast<std::size_t>(i)],
                                      windows[static_cast<std::size_t>(i)])
                            .texture);
    int seen = 0;
    int different = 0;
    for (int y = 0; y < kTile; ++y) {
      for (int x = 0; x < kTile; ++x) {
        const float w = all.at(i * kTile + x, y).w;
        if (!alone.contains(x, y)) {
          EXPECT_EQ(w, kUntouched) << "tile " << i << " reaches beyond its window";
          continue;
        }
        const float expected = alone.at(x, y).w;
        seen += expected > 0.0f ? 1 : 0;
        const float drawn = w == kUntouched ? 0.0f : w;
        different += std::abs(drawn - expected) > test::kSurfaceDepthMm ? 1 : 0;
      }
    }
    EXPECT_GT(seen, 500) << "tile " << i;
    // An offset of whole pixels may round a corner to the next step of the raster.
    EXPECT_LE(static_cast<float>(different), test::kBorderShare * static_cast<float>(seen));
  }
  context().checkGl("tiles");
}

}  // namespace
}  // namespace rangepose::gles
