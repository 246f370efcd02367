#include <gtest/gtest.h>

#include <memory>

#include "gles/stage_set_gles.h"
#include "support/backends.h"

namespace rangepose::gles {
namespace {

using StageSetTest = test::GlesFixture;

/// 8x8 pixels that all hold `value`.
SceneChannels channelsOf(float value) {
  SceneChannels channels;
  channels.camera.width = 8;
  channels.camera.height = 8;
  channels.range_px = Image<float>(8, 8, value);
  channels.edges = channels.range_px;
  channels.distance_px = channels.range_px;
  return channels;
}

TEST_F(StageSetTest, WhatGoesOnOneContextStaysOnAnother) {
  // Names of textures are given anew in each context, so both have the same.
  Context other;
  auto first = makeGlesStages(context());
  const auto second = makeGlesStages(other);
  auto gone = first->scenes->upload(channelsOf(1.0f));
  const auto kept = second->scenes->upload(channelsOf(2.0f));
  // The other context is current now.
  gone.reset();
  first.reset();
  EXPECT_EQ(kept->download().range_px, channelsOf(2.0f).range_px);
  EXPECT_EQ(second->probe->median(channelsOf(3.0f).range_px), channelsOf(3.0f).range_px);
  other.checkGl("after another context's stages went");
}

}  // namespace
}  // namespace rangepose::gles
