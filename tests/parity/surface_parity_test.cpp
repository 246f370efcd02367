// A posed mesh as the camera sees it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "parity/parity_fixture.h"
#include "support/box_mesh.h"
#include "support/tolerances.h"

namespace rangepose {
namespace {

class SurfaceParity : public test::Parity {
 protected:
  void SetUp() override {
    Parity::SetUp();
    if (IsSkipped() || HasFatalFailure()) return;
    if (!drawsByGl()) GTEST_SKIP() << "no hardware GL: the host draws";
  }
};
RP_PARITY_SUBJECTS(SurfaceParity);

Camera perspective() {
  Camera camera;
  camera.width = 640;
  camera.height = 480;
  camera.fx = 610.0;
  camera.fy = 605.0;
  camera.cx = 321.4;
  camera.cy = 238.1;
  return camera;
}

Camera orthographic() {
  Camera camera = perspective();
  camera.orthographic = true;
  camera.pixel_size_mm = 0.31;
  return camera;
}

/// A pose whose centre projects into the image.
Pose poseNear(const Mesh& mesh, const Camera& camera, int index) {
  Pose pose;
  pose.rotation = rotationFromVector({0.7 * index, 0.3 - 0.2 * index, 0.11 * index * index});
  const glm::dvec3 at =
      camera.unproject(200.0 + 37.0 * index, 300.0 - 23.0 * index, 500.0 + 21.0 * index);
  pose.translation_mm = at - pose.rotation * boundingSphere(mesh).center_mm;
  return pose;
}

bool sameTexel(const SurfaceTexel& a, const SurfaceTexel& b) {
  const glm::vec3 normal = glm::abs(glm::vec3(a) - glm::vec3(b));
  return std::max({normal.x, normal.y, normal.z}) <= test::kSurfaceNormal &&
         std::abs(a.w - b.w) <= test::kSurfaceDepthMm;
}

/// Whether the pixel or a neighbour lies at a border of what is seen.
bool atBorder(const Image<SurfaceTexel>& surface, int x, int y) {
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      if (!surface.contains(x + dx, y + dy)) return true;
      const SurfaceTexel& near = surface.at(x + dx, y + dy);
      const SurfaceTexel& here = surface.at(x, y);
      if (glm::vec3(near) != glm::vec3(here) || (near.w == 0.0f) != (here.w == 0.0f)) return true;
    }
  }
  return false;
}

struct Comparison {
  int seen = 0;
  int different = 0;
  int inside = 0;  ///< different, but not at a border
};

Comparison compare(const Image<SurfaceTexel>& actual, const Image<SurfaceTexel>& expected) {
  Comparison result;
  for (int y = 0; y < expected.height(); ++y) {
    for (int x = 0; x < expected.width(); ++x) {
      result.seen += expected.at(x, y).w != 0.0f ? 1 : 0;
      if (sameTexel(actual.at(x, y), expected.at(x, y))) continue;
      ++result.different;
      result.inside += atBorder(expected, x, y) ? 0 : 1;
    }
  }
  return result;
}

TEST_P(SurfaceParity, DiffersOnlyAtBordersOfFaces) {
  const Mesh mesh = test::meshOf(test::bracketBoxes());
  const Sphere sphere = boundingSphere(mesh);
  for (const Camera& camera : {perspective(), orthographic()}) {
    for (int index = 0; index < 8; ++index) {
      const Pose pose = poseNear(mesh, camera, index);
      for (const int max_pixels : {1000, 30}) {
        const SurfaceWindow window =
            windowAround(camera, pose * sphere.center_mm, sphere.radius_mm, max_pixels);
        ASSERT_GT(window.width, 0);
        const Image<SurfaceTexel> expected =
            host().probe->renderSurface(mesh, camera, pose, window);
        const Image<SurfaceTexel> actual =
            subject().probe->renderSurface(mesh, camera, pose, window);
        ASSERT_EQ(actual.width(), expected.width());
        ASSERT_EQ(actual.height(), expected.height());
        const Comparison found = compare(actual, expected);
        const std::string where = "orthographic " + std::to_string(camera.orthographic) +
                                  ", pose " + std::to_string(index) + ", step " +
                                  std::to_string(window.step);
        EXPECT_GT(found.seen, max_pixels == 30 ? 40 : 400) << where;
        EXPECT_LE(found.different, std::ceil(test::kBorderShare * static_cast<float>(found.seen)))
            << where;
        EXPECT_EQ(found.inside, 0) << where;
      }
    }
  }
}

TEST_P(SurfaceParity, TrianglesThatReachBehindTheCameraAreLeftOut) {
  Mesh mesh = test::meshOf(test::bracketBoxes());
  test::addBox(mesh, {{-300.0, -300.0, -900.0}, {-290.0, 300.0, 500.0}});
  Pose pose;
  pose.translation_mm = {0.0, 0.0, 400.0};
  const SurfaceWindow window = {0, 0, 640, 480, 1};
  const Image<SurfaceTexel> expected =
      host().probe->renderSurface(mesh, perspective(), pose, window);
  const Image<SurfaceTexel> actual =
      subject().probe->renderSurface(mesh, perspective(), pose, window);
  const Comparison found = compare(actual, expected);
  EXPECT_GT(found.seen, 400);
  EXPECT_LE(found.different, std::ceil(test::kBorderShare * static_cast<float>(found.seen)));
  pose.translation_mm.z = -2000.0;
  const Image<SurfaceTexel> nothing(640, 480, SurfaceTexel(0.0f));
  EXPECT_EQ(subject().probe->renderSurface(mesh, perspective(), pose, window), nothing);
  EXPECT_EQ(host().probe->renderSurface(mesh, perspective(), pose, window), nothing);
}

TEST_P(SurfaceParity, AChangedMeshAtTheSameAddressIsDrawnAnew) {
  Mesh mesh = test::meshOf(test::bracketBoxes());
  const Camera camera = orthographic();
  Pose pose;
  pose.translation_mm = {0.0, 0.0, 400.0};
  const SurfaceWindow window = {260, 180, 200, 200, 1};
  const Image<SurfaceTexel> before = subject().probe->renderSurface(mesh, camera, pose, window);
  for (glm::vec3& vertex : mesh.vertices) vertex.z += 5.0f;
  const Image<SurfaceTexel> after = subject().probe->renderSurface(mesh, camera, pose, window);
  EXPECT_EQ(compare(after, host().probe->renderSurface(mesh, camera, pose, window)).inside, 0);
  EXPECT_GT(test::differences(before, after), 0);
}

TEST_P(SurfaceParity, AnEmptyWindowIsEmpty) {
  const Mesh mesh = test::meshOf(test::bracketBoxes());
  EXPECT_TRUE(subject().probe->renderSurface(mesh, perspective(), Pose{}, SurfaceWindow{}).empty());
  static_cast<void>(
      subject().probe->median(Image<float>(4, 4, 1.0f)));  // for the fixture's proof of work
}

}  // namespace
}  // namespace rangepose
