// Options out of range are refused by name, before an hour of work ends in nonsense.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "core/error.h"
#include "stages/icp_host.h"
#include "stages/scene_channels.h"
#include "stages/search.h"

namespace rangepose {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// Whether check() refuses the options after `field` was set, and names it.
template <typename Options, typename Field, typename Value>
void expectRefused(Field Options::*field, Value value, const std::string& name) {
  Options options;
  EXPECT_NO_THROW(options.check()) << "the defaults are refused";
  options.*field = static_cast<Field>(value);
  try {
    options.check();
    ADD_FAILURE() << name << " = " << value << " was accepted";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr(name));
  }
}

TEST(OptionsTest, ChannelsNameTheBadField) {
  for (const float value : {0.0f, -0.1f, 1.0f, kNan}) {
    expectRefused(&ChannelOptions::edge_fraction, value, "edge_fraction");
  }
  for (const int value : {0, 7, 257})
    expectRefused(&ChannelOptions::image_width_px, value, "image_width_px");
  for (const int value : {0, -1, 256})
    expectRefused(&ChannelOptions::edt_passes, value, "edt_passes");
}

TEST(OptionsTest, SimplexNamesTheBadField) {
  for (const float value : {0.0f, -2.0f, kNan})
    expectRefused(&SimplexOptions::step_px, value, "step_px");
  for (const float value : {-0.01f, 2.0f, kNan})
    expectRefused(&SimplexOptions::spread, value, "spread");
  for (const int value : {0, -7})
    expectRefused(&SimplexOptions::max_iterations, value, "max_iterations");
}

TEST(OptionsTest, ErrorNamesTheBadField) {
  for (const float value : {-1.0f, kNan, kInfinity})
    expectRefused(&ErrorOptions::lambda, value, "lambda");
  expectRefused(&ErrorOptions::image_width_px, 7, "image_width_px");
  for (const float value : {0.0f, -8.0f, kNan}) {
    expectRefused(&ErrorOptions::range_limit_px, value, "range_limit_px");
  }
  for (const int value : {0, 3}) expectRefused(&ErrorOptions::row_step, value, "row_step");
}

TEST(OptionsTest, AHoleCannotCountAsMuchAsAnInfiniteLimit) {
  ErrorOptions options;
  options.range_limit_px = kInfinity;
  EXPECT_NO_THROW(options.check()) << "the paper has no limit";
  options.holes = HolePolicy::kLimit;
  EXPECT_THROW(options.check(), Error);
}

TEST(OptionsTest, IcpNamesTheBadField) {
  expectRefused(&IcpOptions::iterations, 0, "iterations");
  for (const double value : {1.0, 0.0}) expectRefused(&IcpOptions::first_reach_mm, value, "reach");
  for (const double value : {0.0, -2.0}) expectRefused(&IcpOptions::last_reach_mm, value, "reach");
  expectRefused(&IcpOptions::first_reach_mm, std::numeric_limits<double>::quiet_NaN(), "reach");
  expectRefused(&IcpOptions::slide, -0.1, "slide");
  expectRefused(&IcpOptions::rim_steps, 0, "rim steps");
}

}  // namespace
}  // namespace rangepose
