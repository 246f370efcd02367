#include "sim/drop.h"

#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <map>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "core/error.h"
#include "io/mesh_file.h"
#include "sim/depth_oracle.h"
#include "sim/sim_meshes.h"

namespace rangepose {
namespace {

using ::testing::HasSubstr;

/// A part of the folder models, read and prepared once.
struct Model {
  Mesh mesh;
  PhysicsPart part;
};

Model modelOf(const Mesh& mesh) { return {mesh, physicsPart(mesh)}; }

const Model& model(const std::string& name) {
  static std::map<std::string, Model> models;
  const auto found = models.find(name);
  if (found != models.end()) return found->second;
  const std::filesystem::path path = std::filesystem::path(RP_MODELS_DIR) / (name + ".ply");
  return models.emplace(name, modelOf(readMesh(path, LengthUnit::kMillimetre))).first->second;
}

struct Case {
  std::string name;
  std::vector<Mesh> meshes;
  std::vector<PhysicsPart> parts;
  std::vector<int> counts;
};

Case caseOf(const std::vector<std::string>& names, const std::vector<int>& counts) {
  Case result;
  result.counts = counts;
  for (const std::string& name : names) {
    result.name += (result.name.empty() ? "" : "_") + name;
    result.meshes.push_back(model(name).mesh);
    result.parts.push_back(model(name).part);
  }
  return result;
}

DropOptions seeded(std::uint64_t seed) {
  DropOptions options;
  options.seed = seed;
  return options;
}

bool equal(const DroppedBin& a, const DroppedBin& b) {
  if (a.parts.size() != b.parts.size() || a.bin.inner_mm != b.bin.inner_mm) return false;
  for (std::size_t k = 0; k < a.parts.size(); ++k) {
    const Pose& p = a.parts[k].world_from_object;
    const Pose& q = b.parts[k].world_from_object;
    if (a.parts[k].mesh != b.parts[k].mesh) return false;
    if (p.rotation != q.rotation || p.translation_mm != q.translation_mm) return false;
  }
  return true;
}

/// The deepest that a sample of one part lies in another [mm].
double deepest(const Case& bins, const DroppedBin& bin, int samples) {
  std::vector<test::DepthOracle> oracles;
  std::vector<std::vector<glm::dvec3>> points;
  std::vector<Sphere> spheres;
  Random random(5);
  for (const Mesh& mesh : bins.meshes) {
    oracles.emplace_back(mesh);
    points.push_back(test::surfaceSamples(mesh, samples, random));
    spheres.push_back(boundingSphere(mesh));
  }
  double deepest_mm = 0.0;
  for (const PlacedPart& a : bin.parts) {
    for (const PlacedPart& b : bin.parts) {
      if (&a == &b) continue;
      const auto of_a = static_cast<std::size_t>(a.mesh);
      const auto of_b = static_cast<std::size_t>(b.mesh);
      const Pose b_from_a = b.world_from_object.inverse() * a.world_from_object;
      const double gap = glm::distance(b_from_a * spheres[of_a].center_mm, spheres[of_b].center_mm);
      if (gap > spheres[of_a].radius_mm + spheres[of_b].radius_mm) continue;
      for (const glm::dvec3& point : points[of_a]) {
        deepest_mm = std::max(deepest_mm, oracles[of_b].depth(b_from_a * point));
      }
    }
  }
  return deepest_mm;
}

/// How far vertices lie outside of the bin, or above its rim [mm].
double outside(const Case& bins, const DroppedBin& bin) {
  double farthest = 0.0;
  const glm::dvec3 half = 0.5 * bin.bin.inner_mm;
  for (const PlacedPart& part : bin.parts) {
    for (const glm::vec3& vertex : bins.meshes[static_cast<std::size_t>(part.mesh)].vertices) {
      const glm::dvec3 p = part.world_from_object * glm::dvec3(vertex);
      farthest = std::max({farthest,
                           std::abs(p.x) - half.x,
                           std::abs(p.y) - half.y,
                           -p.z,
                           p.z - bin.bin.inner_mm.z});
    }
  }
  return farthest;
}

double farthestMove(const Case& bins, const DroppedBin& before, const DroppedBin& after) {
  double farthest = 0.0;
  for (std::size_t k = 0; k < before.parts.size(); ++k) {
    const auto mesh = static_cast<std::size_t>(before.parts[k].mesh);
    for (const glm::vec3& vertex : bins.meshes[mesh].vertices) {
      farthest = std::max(farthest,
                          glm::distance(before.parts[k].world_from_object * glm::dvec3(vertex),
                                        after.parts[k].world_from_object * glm::dvec3(vertex)));
    }
  }
  return farthest;
}

double smallestDiameter(const Case& bins) {
  double smallest = bins.parts[0].diameter_mm;
  for (const PhysicsPart& part : bins.parts) smallest = std::min(smallest, part.diameter_mm);
  return smallest;
}

void expectGoodBin(const Case& bins, std::uint64_t seed) {
  SCOPED_TRACE(bins.name + " seed " + std::to_string(seed));
  DropOptions options = seeded(seed);
  const DroppedBin bin = dropParts(bins.parts, bins.counts, options);
  std::vector<int> found(bins.parts.size(), 0);
  for (const PlacedPart& part : bin.parts) ++found.at(static_cast<std::size_t>(part.mesh));
  EXPECT_EQ(found, bins.counts);
  const double d = smallestDiameter(bins);
  const double deepest_mm = deepest(bins, bin, 3000);
  const double outside_mm = outside(bins, bin);
  EXPECT_LE(deepest_mm, 0.01 * d);
  EXPECT_LE(outside_mm, 0.01 * d);
  options.linger_s = 0.5;
  const double moved_mm = farthestMove(bins, bin, dropParts(bins.parts, bins.counts, options));
  EXPECT_GT(moved_mm, 0.0) << "the simulation did not go on";
  EXPECT_LE(moved_mm, 0.005 * d);
  ::testing::Test::RecordProperty(bins.name + "_depth_percent",
                                  std::to_string(100.0 * deepest_mm / d));
  ::testing::Test::RecordProperty(bins.name + "_moved_percent",
                                  std::to_string(100.0 * moved_mm / d));
}

TEST(DropTest, TheOraclesNoticeASpoiltBin) {
  const Case bins = caseOf({"bolt"}, {8});
  DroppedBin bin = dropParts(bins.parts, bins.counts, seeded(6));
  const double d = smallestDiameter(bins);
  const Pose sound = bin.parts[0].world_from_object;
  bin.parts[0].world_from_object = bin.parts[1].world_from_object;
  bin.parts[0].world_from_object.translation_mm.x += 0.05 * d;
  EXPECT_GT(deepest(bins, bin, 3000), 0.02 * d);
  bin.parts[0].world_from_object = sound;
  EXPECT_LE(deepest(bins, bin, 3000), 0.01 * d);
  for (PlacedPart& part : bin.parts) part.world_from_object.translation_mm.z -= 0.03 * d;
  EXPECT_GT(outside(bins, bin), 0.01 * d);
}

TEST(DropTest, TPipesShareNoSpaceStayInTheBinAndLieStill) {
  expectGoodBin(caseOf({"t_pipe"}, {20}), 1);
}

TEST(DropTest, BoltsShareNoSpaceStayInTheBinAndLieStill) {
  expectGoodBin(caseOf({"bolt"}, {30}), 2);
}

TEST(DropTest, ElbowsShareNoSpaceStayInTheBinAndLieStill) {
  expectGoodBin(caseOf({"elbow"}, {20}), 3);
}

TEST(DropTest, AMixtureSharesNoSpaceStaysInTheBinAndLiesStill) {
  expectGoodBin(caseOf({"t_pipe", "bolt", "elbow", "bracket"}, {5, 8, 5, 7}), 4);
}

TEST(DropTest, AnElongatedBoxComesToRestOnAFace) {
  const Model box = modelOf(boxMesh({-40, -15, -8}, {40, 15, 8}));
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    DropOptions options = seeded(seed);
    options.bin.inner_mm = {600, 600, 100};  // too wide to lean on a wall
    const DroppedBin bin = dropParts({box.part}, {1}, options);
    int on_floor = 0;
    for (const glm::vec3& vertex : box.mesh.vertices) {
      const double z = (bin.parts[0].world_from_object * glm::dvec3(vertex)).z;
      EXPECT_GE(z, -0.01 * box.part.diameter_mm);
      on_floor += z < 0.01 * box.part.diameter_mm ? 1 : 0;
    }
    EXPECT_EQ(on_floor, 4);
  }
}

TEST(DropTest, OrientationsDifferFromSeedToSeed) {
  const Case bins = caseOf({"bolt"}, {3});
  const DroppedBin first = dropParts(bins.parts, bins.counts, seeded(1));
  const DroppedBin second = dropParts(bins.parts, bins.counts, seeded(2));
  EXPECT_GT(rotationAngleBetween(first.parts[0].world_from_object.rotation,
                                 second.parts[0].world_from_object.rotation),
            0.1);
}

TEST(DropTest, EqualSeedsGiveEqualBitsWhateverRunsBeside) {
  const Case bins = caseOf({"bolt", "t_pipe"}, {7, 4});
  constexpr std::size_t kBins = 4;
  std::vector<DroppedBin> alone;
  for (std::size_t k = 0; k < kBins; ++k) {
    alone.push_back(dropParts(bins.parts, bins.counts, seeded(k + 1)));
  }
  std::vector<DroppedBin> together(kBins);
  std::vector<std::thread> threads;
  for (std::size_t k = 0; k < kBins; ++k) {
    threads.emplace_back(
        [&, k] { together[k] = dropParts(bins.parts, bins.counts, seeded(k + 1)); });
  }
  for (std::thread& thread : threads) thread.join();
  for (std::size_t k = 0; k < kBins; ++k) EXPECT_TRUE(equal(alone[k], together[k])) << k;
  EXPECT_FALSE(equal(alone[0], alone[1]));
}

TEST(DropTest, PartsThatAreNotDroppedDoNotMatter) {
  const DroppedBin alone = dropParts({model("bolt").part}, {6}, seeded(3));
  DroppedBin beside = dropParts({model("elbow").part, model("bolt").part}, {0, 6}, seeded(3));
  for (PlacedPart& part : beside.parts) {
    EXPECT_EQ(part.mesh, 1);
    part.mesh = 0;
  }
  EXPECT_TRUE(equal(alone, beside));
}

TEST(DropTest, AGivenBinIsKept) {
  DropOptions options = seeded(1);
  options.bin.inner_mm = {300, 200, 150};
  const Case bins = caseOf({"bolt"}, {10});
  const DroppedBin bin = dropParts(bins.parts, bins.counts, options);
  EXPECT_EQ(bin.bin.inner_mm, glm::dvec3(300, 200, 150));
  EXPECT_LE(outside(bins, bin), 0.01 * smallestDiameter(bins));
}

TEST(DropTest, AFullBinIsAnError) {
  DropOptions options = seeded(1);
  options.attempts = 2;
  // Enough room for all as one block, not as a heap; and not even that.
  const std::pair<double, std::string> heights[] = {{50.0, "over the rim"}, {30.0, "more volume"}};
  for (const auto& [height_mm, why] : heights) {
    options.bin.inner_mm = {120, 120, height_mm};
    try {
      dropParts({model("bolt").part}, {32}, options);
      ADD_FAILURE() << "32 bolts cannot lie in it";
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), HasSubstr(why));
      EXPECT_THAT(error.what(), HasSubstr("larger bin"));
    }
  }
}

TEST(DropTest, ABinNarrowerThanThePartIsAnError) {
  DropOptions options = seeded(1);
  options.bin.inner_mm = {30, 200, 150};
  EXPECT_THROW(dropParts({model("elbow").part}, {1}, options), Error);
}

TEST(DropTest, BadCountsAndOptionsAreRefused) {
  const std::vector<PhysicsPart> parts = {model("bolt").part};
  EXPECT_THROW(dropParts(parts, {0}, {}), Error);
  EXPECT_THROW(dropParts(parts, {-1}, {}), Error);
  EXPECT_THROW(dropParts(parts, {1, 1}, {}), Error);
  DropOptions options;
  options.friction = -0.1;
  EXPECT_THROW(dropParts(parts, {1}, options), Error);
  options = {};
  options.bin.inner_mm.x = -5.0;
  EXPECT_THROW(dropParts(parts, {1}, options), Error);
  options = {};
  options.attempts = 0;
  EXPECT_THROW(dropParts(parts, {1}, options), Error);
}

}  // namespace
}  // namespace rangepose
