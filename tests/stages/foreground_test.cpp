// What is kept of a depth image and what is background.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "sim/heap.h"
#include "sim/scanner.h"
#include "stages/foreground_host.h"
#include "support/bins.h"

namespace rangepose {
namespace {

using test::aboveTable;
using test::boxAt;
using test::emptyBin;

Camera camera() { return test::pinholeCamera(320, 240, 420.0); }

DepthImage nothing() { return {camera(), Image<float>(320, 240, 0.0f)}; }

Mesh threeParts() {
  return test::meshOf({boxAt(-70.0, -40.0, {50.0, 30.0, 22.0}),
                       boxAt(20.0, -10.0, {30.0, 45.0, 28.0}),
                       boxAt(-30.0, 20.0, {25.0, 25.0, 35.0})});
}

ForegroundOptions optionsFor(double part_mm) {
  ForegroundOptions options;
  options.part_mm = part_mm;
  options.tolerance_mm = 2.0;
  return options;
}

/// Parts on what is drawn already; gives the pixels that show them.
Image<std::uint8_t> addParts(DepthImage& image, const Mesh& parts, const Pose& pose) {
  const Image<float> before = image.depth_mm;
  test::measure(image, parts, pose);
  Image<std::uint8_t> shown(before.width(), before.height(), 0);
  for (std::size_t i = 0; i < shown.size(); ++i)
    shown.data()[i] = image.depth_mm.data()[i] != before.data()[i] ? 1 : 0;
  return shown;
}

double heightAt(const DepthImage& image, const Pose& pose, int u, int v) {
  return (pose.inverse() * image.camera.unproject(u, v, image.depth_mm.at(u, v))).z;
}

struct Tally {
  int parts = 0;
  int parts_kept = 0;
  int other = 0;
  int other_kept = 0;
};

/// Pixels of parts count where they are `above_mm` over the floor or more.
Tally tallyOf(const DepthImage& image,
              const Image<std::uint8_t>& mask,
              const Image<std::uint8_t>& parts,
              const Pose& pose,
              double above_mm) {
  Tally tally;
  for (int v = 0; v < mask.height(); ++v) {
    for (int u = 0; u < mask.width(); ++u) {
      if (image.depth_mm.at(u, v) == 0.0f) {
        EXPECT_EQ(mask.at(u, v), 0) << "not measured";
        continue;
      }
      if (parts.at(u, v) == 0) {
        ++tally.other;
        tally.other_kept += mask.at(u, v);
      } else if (heightAt(image, pose, u, v) > above_mm) {
        ++tally.parts;
        tally.parts_kept += mask.at(u, v);
      }
    }
  }
  return tally;
}

struct TableScene {
  Pose pose = aboveTable(450.0);
  DepthImage image = nothing();
  Image<std::uint8_t> parts;

  TableScene() {
    test::measure(image, test::plateMesh(700.0, 700.0), pose);
    parts = addParts(image, threeParts(), pose);
  }
};

TEST(ForegroundTest, TableIsFoundAndOnlyTheTableRemoved) {
  const TableScene scene;
  const ForegroundOptions options = optionsFor(62.0);
  const std::vector<BackgroundPlane> planes = host::findBackground(scene.image, options);
  ASSERT_EQ(planes.size(), 1u);
  const glm::dvec3 up = scene.pose.rotation[2];
  EXPECT_GT(glm::dot(planes[0].normal, up), std::cos(0.01));
  EXPECT_NEAR(planes[0].heightOf(scene.pose.translation_mm), 0.0, 0.5);
  EXPECT_GT(planes[0].heightOf(glm::dvec3(0.0)), 0.0) << "normal points away from the camera";
  const Image<std::uint8_t> mask = host::foregroundMask(scene.image, planes, std::nullopt, options);
  const Tally tally = tallyOf(scene.image, mask, scene.parts, scene.pose, 4.0);
  EXPECT_EQ(tally.other_kept, 0) << "of " << tally.other;
  EXPECT_EQ(tally.parts_kept, tally.parts);
  EXPECT_GT(tally.parts, 3000);
}

TEST(ForegroundTest, SameAnswerTwice) {
  const TableScene scene;
  const std::vector<BackgroundPlane> first = host::findBackground(scene.image, optionsFor(62.0));
  const std::vector<BackgroundPlane> second = host::findBackground(scene.image, optionsFor(62.0));
  ASSERT_EQ(first.size(), second.size());
  ASSERT_FALSE(first.empty());
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_TRUE(first[i].normal == second[i].normal);
    EXPECT_EQ(first[i].offset_mm, second[i].offset_mm);
  }
}

TEST(ForegroundTest, FloorAndWallsAreRemoved) {
  const Pose bin = aboveTable(470.0);
  DepthImage image = emptyBin(camera(), bin, {-1.0, 1.0});
  const Image<std::uint8_t> parts = addParts(image, threeParts(), bin);
  const ForegroundOptions options = optionsFor(62.0);
  const std::vector<BackgroundPlane> planes = host::findBackground(image, options);
  ASSERT_EQ(planes.size(), 3u);
  EXPECT_GT(glm::dot(planes[0].normal, bin.rotation[2]), std::cos(0.01));
  for (std::size_t i = 1; i < 3; ++i)
    EXPECT_GT(std::abs(glm::dot(planes[i].normal, bin.rotation[0])), std::cos(0.02));
  const Image<std::uint8_t> mask = host::foregroundMask(image, planes, std::nullopt, options);
  const Tally tally = tallyOf(image, mask, parts, bin, 4.0);
  EXPECT_EQ(tally.other_kept, 0) << "of " << tally.other;
  EXPECT_EQ(tally.parts_kept, tally.parts);
  EXPECT_GT(tally.parts, 3000);
}

/// The parts lie on top of each other. Where most of them lie flat beside each other, their faces
/// are one plane with other parts standing out of it, which cannot be told from a floor.
TEST(ForegroundTest, HeapWithoutFloorLosesNothing) {
  const Mesh mesh = test::meshOf(test::bracketBoxes());
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    HeapOptions heap_options;
    heap_options.count = 14;
    heap_options.seed = seed;
    heap_options.radius_mm = 15.0;
    const std::vector<PlacedPart> heap = makeHeap({mesh}, heap_options);
    ScannerOptions scanner;
    scanner.width = 320;
    scanner.height = 240;
    scanner.distance_mm = 330.0;
    const CleanView view =
        renderHeap({mesh}, heap, scannerCamera(scanner), scannerPose(heap, scanner));
    DepthImage image{view.camera, Image<float>(320, 240, 0.0f)};
    Image<std::uint8_t> measured(320, 240, 0);
    for (std::size_t i = 0; i < measured.size(); ++i) {
      if (view.part.data()[i] < 0) continue;
      image.depth_mm.data()[i] = view.surface.data()[i].w;
      measured.data()[i] = 1;
    }
    const ForegroundOptions options = optionsFor(diameter(mesh));
    const std::vector<BackgroundPlane> planes = host::findBackground(image, options);
    EXPECT_TRUE(planes.empty()) << "seed " << seed;
    EXPECT_TRUE(host::foregroundMask(image, planes, std::nullopt, options) == measured);
  }
}

TEST(ForegroundTest, FlatPartsSideBySideKeepTheirFaces) {
  DepthImage image = nothing();
  const Mesh parts =
      test::meshOf({boxAt(-65.0, -20.0, {60.0, 40.0, 6.0}), boxAt(3.0, -20.0, {60.0, 40.0, 6.0})});
  const Image<std::uint8_t> shown = addParts(image, parts, aboveTable(420.0));
  const ForegroundOptions options = optionsFor(72.0);
  const std::vector<BackgroundPlane> planes = host::findBackground(image, options);
  EXPECT_TRUE(planes.empty());
  EXPECT_TRUE(host::foregroundMask(image, planes, std::nullopt, options) == shown);
}

/// A bin with a wall, a box, and a large sheet behind which nothing lies.
struct SheetInABin {
  Pose bin = aboveTable(470.0);
  DepthImage image = emptyBin(camera(), bin, {1.0});
  Image<std::uint8_t> sheet;

  SheetInABin() {
    Pose leaning;
    leaning.rotation = rotationFromVector({0.0, -0.65 * std::numbers::pi, 0.0});
    leaning.translation_mm = {-20.0, -30.0, 2.0};
    sheet = addParts(image, test::meshOf({{{0, 0, 0}, {80, 60, 2}}}), bin * leaning);
    addParts(image, test::meshOf({boxAt(50.0, -20.0, {40.0, 40.0, 20.0})}), bin);
  }
};

TEST(ForegroundTest, SheetThatLeansInTheBinIsNoWall) {
  const SheetInABin scene;
  ForegroundOptions options = optionsFor(100.0);
  options.tolerance_mm = 0.6;
  const std::vector<BackgroundPlane> without = host::findBackground(scene.image, options);
  EXPECT_EQ(without.size(), 3u) << "the sheet alone could not be told from a wall";
  options.flat_face = {80.0, 60.0};
  const std::vector<BackgroundPlane> planes = host::findBackground(scene.image, options);
  ASSERT_EQ(planes.size(), 2u) << "floor and wall";
  const Image<std::uint8_t> mask = host::foregroundMask(scene.image, planes, std::nullopt, options);
  const Tally tally = tallyOf(scene.image, mask, scene.sheet, scene.bin, 4.0);
  EXPECT_EQ(tally.parts_kept, tally.parts) << "a part in plain view would be lost";
  EXPECT_GT(tally.parts, 1000);
}

TEST(ForegroundTest, EmptyImageHasNoBackground) {
  EXPECT_TRUE(host::findBackground(nothing(), optionsFor(62.0)).empty());
  const Image<std::uint8_t> mask =
      host::foregroundMask(nothing(), {}, std::nullopt, optionsFor(62.0));
  EXPECT_TRUE(mask == Image<std::uint8_t>(320, 240, 0));
}

TEST(ForegroundTest, BoxRemovesWhatIsOutsideAndItsFloor) {
  const TableScene scene;
  const ForegroundOptions options = optionsFor(62.0);
  // Around the first part alone.
  BinBox bin;
  bin.camera_from_bin = scene.pose * Pose{glm::dmat3(1.0), {-45.0, -25.0, 0.0}};
  bin.inner_size_mm = {80.0, 60.0, 100.0};
  const Image<std::uint8_t> mask = host::foregroundMask(scene.image, {}, bin, options);
  int kept = 0;
  for (int v = 0; v < mask.height(); ++v) {
    for (int u = 0; u < mask.width(); ++u) {
      const glm::dvec3 inside = bin.camera_from_bin.inverse() *
                                scene.image.camera.unproject(u, v, scene.image.depth_mm.at(u, v));
      if (mask.at(u, v) != 0) {
        ++kept;
        EXPECT_TRUE(std::abs(inside.x) < 40.0 && std::abs(inside.y) < 30.0 && inside.z > 0.0);
        EXPECT_EQ(scene.parts.at(u, v), 1) << "floor at " << u << ", " << v;
      } else {
        EXPECT_FALSE(std::abs(inside.x) < 36.0 && std::abs(inside.y) < 26.0 && inside.z > 4.0)
            << u << ", " << v;
      }
    }
  }
  EXPECT_GT(kept, 1000);
}

TEST(ForegroundTest, PartsAboveTheRimOfTheBoxStay) {
  const TableScene scene;
  BinBox bin;
  bin.camera_from_bin = scene.pose;
  bin.inner_size_mm = {400.0, 400.0, 10.0};
  const Image<std::uint8_t> mask = host::foregroundMask(scene.image, {}, bin, optionsFor(62.0));
  const Tally tally = tallyOf(scene.image, mask, scene.parts, scene.pose, 20.0);
  EXPECT_EQ(tally.parts_kept, tally.parts);
  EXPECT_GT(tally.parts, 1000);
}

}  // namespace
}  // namespace rangepose
