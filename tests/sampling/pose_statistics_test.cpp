// The file of pose statistics: read back as written, or refused.
#include "sampling/pose_statistics.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "core/error.h"
#include "core/pose.h"
#include "geometry/orientation_grid.h"

namespace rangepose {
namespace {

using testing::HasSubstr;

PoseStatistics someStatistics(int count) {
  PoseStatistics statistics;
  statistics.mesh_hash = 0x123456789abcdef0ULL;
  statistics.seed = 77;
  statistics.bins = 12;
  statistics.parts = count + 5;
  statistics.rotations = uniformRotations(count);
  return statistics;
}

std::string messageFor(const std::vector<char>& bytes) {
  try {
    deserializeStatistics(bytes, "bolt.poses");
  } catch (const Error& error) {
    return error.what();
  }
  return "accepted";
}

TEST(PoseStatisticsTest, ComesBackAsItWasWritten) {
  PoseStatistics statistics = someStatistics(3000);
  // Half turns, where the largest component of the quaternion is not w.
  for (const glm::dvec3& axis : {glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0), glm::dvec3(0, 0, 1)}) {
    statistics.rotations.push_back(rotationFromVector(3.14159265358979 * axis));
  }
  statistics.rotations.emplace_back(1.0);
  const PoseStatistics back = deserializeStatistics(serialize(statistics), "bolt.poses");
  EXPECT_EQ(back.mesh_hash, statistics.mesh_hash);
  EXPECT_EQ(back.seed, statistics.seed);
  EXPECT_EQ(back.bins, statistics.bins);
  EXPECT_EQ(back.parts, statistics.parts);
  ASSERT_EQ(back.rotations.size(), statistics.rotations.size());
  for (std::size_t i = 0; i < back.rotations.size(); ++i) {
    EXPECT_LT(rotationAngleBetween(back.rotations[i], statistics.rotations[i]), 0.01 / 57.3);
    EXPECT_NEAR(glm::determinant(back.rotations[i]), 1.0, 1e-12);
  }
}

TEST(PoseStatisticsTest, TheLargestFileIsSmall) {
  PoseStatistics statistics = someStatistics(static_cast<int>(kMostKeptRotations));
  EXPECT_LE(serialize(statistics).size(), 50000u);
  statistics.rotations.emplace_back(1.0);
  EXPECT_THROW(serialize(statistics), Error);
}

TEST(PoseStatisticsTest, DamageAndTruncationAreRefused) {
  const std::vector<char> bytes = serialize(someStatistics(40));
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    EXPECT_NE(messageFor({bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(i)}),
              "accepted");
    std::vector<char> damaged = bytes;
    damaged[i] = static_cast<char>(damaged[i] ^ 0x10);
    EXPECT_NE(messageFor(damaged), "accepted") << "byte " << i;
  }
  std::vector<char> longer = bytes;
  longer.push_back(0);
  EXPECT_THAT(messageFor(longer), HasSubstr("after the end"));
  EXPECT_THAT(messageFor({'p', 'l', 'y', '\n'}), HasSubstr("bolt.poses: not a rangepose"));
}

TEST(PoseStatisticsTest, ImpossibleCountsAreRefused) {
  PoseStatistics none = someStatistics(3);
  none.rotations.clear();
  EXPECT_THAT(messageFor(serialize(none)), HasSubstr("orientations"));
  PoseStatistics no_bins = someStatistics(3);
  no_bins.bins = 0;
  EXPECT_THAT(messageFor(serialize(no_bins)), HasSubstr("bins"));
  PoseStatistics few_parts = someStatistics(3);
  few_parts.parts = 2;
  EXPECT_THAT(messageFor(serialize(few_parts)), HasSubstr("parts"));
}

TEST(PoseStatisticsTest, AMissingFileIsNamed) {
  for (const std::filesystem::path& path :
       {std::filesystem::path("/nowhere/bolt.poses"), std::filesystem::temp_directory_path()}) {
    try {
      readStatistics(path);
      ADD_FAILURE() << path << " was read";
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), HasSubstr(path.string()));
    }
  }
}

}  // namespace
}  // namespace rangepose
