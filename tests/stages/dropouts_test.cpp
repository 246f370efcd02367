// A sensor that loses every tenth pixel leaves parts with more outline than surface: they would be
// found, and not trusted.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "stages/dropouts_host.h"
#include "support/shapes.h"

namespace rangepose {
namespace {

/// A slope, and beyond column 60 another surface 20 mm behind it.
class DropoutsTest : public testing::Test {
 protected:
  DropoutsTest() {
    image_.camera = test::pinholeCamera(120, 90, 300.0);
    image_.depth_mm = Image<float>(120, 90);
    for (int v = 0; v < 90; ++v) {
      for (int u = 0; u < 120; ++u) image_.depth_mm.at(u, v) = truth(u, v);
    }
  }
  static float truth(int u, int v) {
    return 500.0f + 0.6f * static_cast<float>(u) - 0.3f * static_cast<float>(v) +
           (u > 60 ? 20.0f : 0.0f);
  }
  /// Of all pixels. Gives how many were lost.
  int lose(double share) {
    std::mt19937 random(3);
    int lost = 0;
    for (float& mm : image_.depth_mm) {
      if (static_cast<double>(random()) >= share * 4294967296.0) continue;
      mm = 0.0f;
      ++lost;
    }
    return lost;
  }
  static bool atEdge(int u, int v) {
    return u == 0 || v == 0 || u == 119 || v == 89 || (u >= 60 && u <= 61);
  }

  DepthImage image_;
};

TEST_F(DropoutsTest, WhatWasLostHereAndThereIsFilledAsItsSurfaceGoesOn) {
  lose(0.1);
  const DepthImage filled = host::fillDropouts(image_, 0.1);
  int open = 0;
  int closed = 0;
  for (int v = 0; v < 90; ++v) {
    for (int u = 0; u < 120; ++u) {
      if (image_.depth_mm.at(u, v) != 0.0f) {
        EXPECT_EQ(filled.depth_mm.at(u, v), image_.depth_mm.at(u, v)) << "measured pixels stay";
      } else if (atEdge(u, v)) {
        EXPECT_EQ(filled.depth_mm.at(u, v), 0.0f) << "between two surfaces nothing is known";
      } else if (filled.depth_mm.at(u, v) == 0.0f) {
        ++open;
      } else {
        ++closed;
        EXPECT_NEAR(filled.depth_mm.at(u, v), truth(u, v), 1e-3f);
      }
    }
  }
  EXPECT_GT(closed, 20 * open);
}

TEST_F(DropoutsTest, LargerHolesStay) {
  for (int v = 20; v < 50; ++v) {
    for (int u = 10; u < 40; ++u) image_.depth_mm.at(u, v) = 0.0f;
  }
  lose(0.1);
  const DepthImage filled = host::fillDropouts(image_, 0.1);
  for (int v = 21; v < 49; ++v) {
    for (int u = 11; u < 39; ++u) EXPECT_EQ(filled.depth_mm.at(u, v), 0.0f) << "a shadow";
  }
}

TEST_F(DropoutsTest, FewHolesStay) {
  ASSERT_GT(lose(0.005), 20);
  EXPECT_EQ(host::fillDropouts(image_, 0.1).depth_mm, image_.depth_mm)
      << "a sensor that loses few pixels loses them for a reason";
}

TEST_F(DropoutsTest, AnImageWithoutMeasurementStaysEmpty) {
  image_.depth_mm = Image<float>(120, 90, 0.0f);
  EXPECT_EQ(host::fillDropouts(image_, 0.0).depth_mm, image_.depth_mm);
}

}  // namespace
}  // namespace rangepose
