// The statistics that come with the parts in models/: they belong to their meshes, and adaptive
// views made from them cover orientations from other bins better than uniform ones.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <utility>

#include "core/pose.h"
#include "geometry/orientation_grid.h"
#include "geometry/symmetry.h"
#include "io/mesh_file.h"
#include "sampling/pose_statistics.h"
#include "sampling/view_sampling.h"

namespace rangepose {
namespace {

class ShippedStatisticsTest : public testing::TestWithParam<const char*> {
 protected:
  std::filesystem::path file(const std::string& extension) const {
    return std::filesystem::path(RP_MODELS_DIR) / (GetParam() + extension);
  }
};

TEST_P(ShippedStatisticsTest, BelongToTheMesh) {
  const PoseStatistics statistics = readStatistics(file(".poses"));
  EXPECT_EQ(statistics.mesh_hash, meshHash(readMesh(file(".ply"), LengthUnit::kMillimetre)));
  EXPECT_GE(statistics.bins, 100);
  EXPECT_GE(statistics.rotations.size(), 6000u);
  EXPECT_LE(std::filesystem::file_size(file(".poses")), 60000u);
}

TEST_P(ShippedStatisticsTest, AdaptiveViewsCoverOtherBinsBetter) {
  const Mesh mesh = readMesh(file(".ply"), LengthUnit::kMillimetre);
  const Symmetries symmetries = findSymmetries(mesh);
  const std::vector<glm::dmat3> all = readStatistics(file(".poses")).rotations;
  // Bins lie one after the other: the last quarter is of other bins than the rest.
  const std::size_t cut = all.size() * 3 / 4;
  const std::vector<glm::dmat3> seen(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(cut));
  std::vector<glm::dmat3> others;
  for (std::size_t i = cut; i < all.size(); i += 2) {
    const double spin = 2.399963 * static_cast<double>(i);
    others.push_back(rotationFromVector({0.0, 0.0, spin}) * all[i]);
  }
  AdaptiveOptions options;
  const Coverage adaptive =
      coverageOf(symmetries, adaptiveViews(symmetries, seen, options), others);
  const Coverage uniform = coverageOf(symmetries, uniformViews(symmetries, options.views), others);
  for (const auto& [name, coverage] : {std::pair{"adaptive", adaptive}, {"uniform", uniform}}) {
    RecordProperty(std::string(name) + "_mean_deg", std::to_string(57.2957795 * coverage.mean));
    RecordProperty(std::string(name) + "_95_deg",
                   std::to_string(57.2957795 * coverage.percentile_95));
  }
  EXPECT_LT(adaptive.mean, 0.93 * uniform.mean);
  EXPECT_LT(adaptive.percentile_95, 1.03 * uniform.percentile_95);
  // Against the grid that knows of no symmetry, and that of the paper.
  const Coverage grid = coverageOf(symmetries, uniformRotations(options.views), others);
  EXPECT_LT(adaptive.mean, 0.88 * grid.mean);
  EXPECT_LT(adaptive.percentile_95, 0.98 * grid.percentile_95);
  EXPECT_LT(adaptive.largest, 1.15 * grid.largest);
}

INSTANTIATE_TEST_SUITE_P(Models,
                         ShippedStatisticsTest,
                         testing::Values("t_pipe", "bolt", "elbow", "bracket"),
                         [](const auto& model) { return std::string(model.param); });

}  // namespace
}  // namespace rangepose
