// What is kept of each object must not grow with the number of objects, nor go while it is in use.
#include "core/kept.h"

#include <gtest/gtest.h>

#include <string>

namespace rangepose {
namespace {

TEST(KeptTest, WhatWasMadeIsNotMadeAgain) {
  Kept<int, std::string> kept(2);
  int made = 0;
  const auto make = [&] { return std::to_string(++made); };
  EXPECT_EQ(*kept.of(7, make), "1");
  EXPECT_EQ(*kept.of(7, make), "1");
  EXPECT_EQ(*kept.of(8, make), "2");
  EXPECT_EQ(made, 2);
}

TEST(KeptTest, TheOneThatWasNotUsedForLongestGoes) {
  Kept<int, std::string> kept(2);
  int made = 0;
  const auto make = [&] { return std::to_string(++made); };
  kept.of(1, make);
  kept.of(2, make);
  kept.of(1, make);
  kept.of(3, make);
  EXPECT_EQ(kept.size(), 2u);
  EXPECT_EQ(*kept.of(1, make), "1");
  EXPECT_EQ(*kept.of(2, make), "4") << "2 was dropped for 3";
}

TEST(KeptTest, WhatIsInUseOutlivesItsPlace) {
  Kept<int, std::string> kept(1);
  const auto held = kept.of(1, [] { return std::string("first"); });
  kept.of(2, [] { return std::string("second"); });
  EXPECT_EQ(*held, "first");
  EXPECT_EQ(kept.size(), 1u);
}

TEST(KeptTest, WhatCouldNotBeMadeTakesNoPlace) {
  Kept<int, std::string> kept(1);
  kept.of(1, [] { return std::string("first"); });
  EXPECT_THROW(kept.of(2, []() -> std::string { throw 3; }), int);
  EXPECT_EQ(*kept.of(1, [] { return std::string("again"); }), "first");
}

}  // namespace
}  // namespace rangepose
