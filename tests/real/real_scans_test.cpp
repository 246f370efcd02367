// The main job on real scans. They are not part of the project: RANGEPOSE_REAL_SCANS names their
// folder, without it these tests skip. There is no ground truth; what is asserted are scores, and
// that nothing is found where there is nothing to find. Whether a pose is right is judged by eye on
// the overlays that tools/real_scans writes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "database/reference_database.h"
#include "geometry/orientation_grid.h"
#include "geometry/symmetry.h"
#include "io/camera_file.h"
#include "io/depth_file.h"
#include "io/mesh_file.h"
#include "pipeline/estimate.h"
#include "stages/reference_host.h"

namespace rangepose {
namespace {

namespace fs = std::filesystem;

class RealScansTest : public ::testing::Test {
 protected:
  void SetUp() override {
    const char* folder = std::getenv("RANGEPOSE_REAL_SCANS");
    if (folder == nullptr) GTEST_SKIP() << "RANGEPOSE_REAL_SCANS is not set";
    scans_ = folder;
    ASSERT_TRUE(fs::is_directory(scans_)) << scans_ << " is no folder";
  }

  ReferenceDatabase databaseOf(const std::string& model) const {
    constexpr int kSize = 64;
    const ChannelOptions options = channelOptionsFor(kSize);
    ReferenceDatabase database;
    database.objects.push_back(describeObject(readMesh(scans_ / model, LengthUnit::kMillimetre),
                                              1,
                                              kSize,
                                              uniformRotations(1024),
                                              options));
    setSymmetries(database.objects.front(), findSymmetries(database.objects.front().mesh));
    host::renderReferences(database.objects.front(), options, {});
    return database;
  }

  /// Score of the best pose, 0 for none.
  double bestScore(const ReferenceDatabase& database,
                   const fs::path& depth,
                   const fs::path& camera) {
    EstimateOptions options;
    options.min_score = 0.0;
    const DepthImage image = readDepth(scans_ / depth, readCamera(scans_ / camera));
    const Estimate estimate = estimatePoses(image, std::nullopt, database, options, *stages_);
    const double score = estimate.poses.empty() ? 0.0 : estimate.poses.front().confidence;
    std::cout << depth.string() << ": " << database.objects.front().mesh.name << " " << score
              << "\n";
    return score;
  }

  std::vector<fs::path> depthImages(const std::string& folder, const std::string& prefix) const {
    std::vector<fs::path> images;
    for (const fs::directory_entry& entry : fs::directory_iterator(scans_ / folder / "depth")) {
      const fs::path name = entry.path().filename();
      if (name.extension() == ".png" && name.string().rfind(prefix, 0) == 0) {
        images.push_back(fs::path(folder) / "depth" / name);
      }
    }
    std::sort(images.begin(), images.end());
    return images;
  }

  fs::path scans_;
  std::unique_ptr<StageSet> stages_ = makeHostStages();
};

constexpr double kReported = 0.5;  // EstimateOptions::min_score

TEST_F(RealScansTest, ElbowsAreFoundInRealBins) {
  const ReferenceDatabase elbow = databaseOf("elbow_bins/models/elbow_90.stl");
  const std::vector<fs::path> bins = depthImages("elbow_bins", "90_");
  int found = 0;
  for (const fs::path& bin : bins) {
    found += bestScore(elbow, bin, "elbow_bins/camera.json") >= kReported ? 1 : 0;
  }
  EXPECT_GE(found, 11) << "of " << bins.size();
}

TEST_F(RealScansTest, PrismsAreFoundInPartScenes) {
  const ReferenceDatabase part = databaseOf("prism_parts/models/part.ply");
  int found = 0;
  for (const std::string scene :
       {"scene062P", "test_seg_3pecas", "scene_multi_062", "Atest_pecasfinal"}) {
    const std::string stem = "prism_parts/depth/" + scene;
    found += bestScore(part, stem + ".png", stem + ".camera.json") >= kReported ? 1 : 0;
  }
  EXPECT_GE(found, 3) << "of 4";
}

TEST_F(RealScansTest, NothingIsReportedAmongOtherThings) {
  const ReferenceDatabase elbow = databaseOf("elbow_bins/models/elbow_90.stl");
  const ReferenceDatabase part = databaseOf("prism_parts/models/part.ply");
  for (const fs::path& bin : depthImages("clutter_without_models", "")) {
    for (const ReferenceDatabase* database : {&elbow, &part}) {
      EXPECT_LT(bestScore(*database, bin, "clutter_without_models/camera.json"), kReported)
          << bin << " holds no " << database->objects.front().mesh.name;
    }
  }
}

}  // namespace
}  // namespace rangepose
