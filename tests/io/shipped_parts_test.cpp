// The parts in models/ and its folders are what models/README.md says. Figures measured on a part
// that is open, that has another symmetry or that is no piece of its neighbour say nothing of that
// case.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <set>
#include <string>
#include <utility>

#include "geometry/solid.h"
#include "geometry/surface_sample.h"
#include "geometry/symmetry.h"
#include "geometry/triangle_tree.h"
#include "io/mesh_file.h"

namespace rangepose {
namespace {

using Part = std::pair<const char*, const char*>;  // name below models/, symmetry

constexpr Part kParts[] = {{"t_pipe", "C2"},
                           {"bolt", "C6"},
                           {"elbow", "C2"},
                           {"bracket", "none"},
                           {"fitting/angle", "none"},
                           {"fitting/block", "D2"},
                           {"fitting/pin", "revolution"},
                           {"fitting/plate", "D2"},
                           {"fitting/rod", "revolution, ends alike"},
                           {"tuning/clamp", "C2"},
                           {"tuning/crank", "none"},
                           {"tuning/knob", "C5"},
                           {"tuning/pulley", "revolution"},
                           {"tuning/spacer", "D3"},
                           {"tuning/valve_body", "none"},
                           {"reporting/clevis_pin", "C2"},
                           {"reporting/cup", "none"},
                           {"reporting/dowel", "revolution, ends alike"},
                           {"reporting/flange", "C3"},
                           {"reporting/lever", "none"},
                           {"reporting/plug", "C2"},
                           {"reporting/star_knob", "C5"},
                           {"reporting/thin_plate", "none"}};

std::filesystem::path fileOf(const std::string& part) {
  return std::filesystem::path(RP_MODELS_DIR) / (part + ".ply");
}

Mesh meshOf(const std::string& part) { return readMesh(fileOf(part), LengthUnit::kMillimetre); }

/// Greatest distance [mm] from points of a surface, moved along z by `along_mm`, to another
/// surface; without the points that are left out.
double farthest(const Mesh& from,
                double along_mm,
                const Mesh& to,
                const std::function<bool(const glm::dvec3&)>& left_out) {
  const TriangleTree tree(to);
  double farthest_mm2 = 0.0;
  int kept = 0;
  for (const glm::dvec3& point : surfaceSample(from, 4000)) {
    if (left_out(point)) continue;
    ++kept;
    const glm::dvec3 there = point + glm::dvec3(0.0, 0.0, along_mm);
    farthest_mm2 = std::max(farthest_mm2, tree.nearest(there).squared_mm2);
  }
  EXPECT_GT(kept, 2000) << "too few points to tell";
  return std::sqrt(farthest_mm2);
}

class ShippedPartTest : public testing::TestWithParam<Part> {};

TEST_P(ShippedPartTest, IsSolidAndSmall) {
  const Mesh mesh = meshOf(GetParam().first);
  EXPECT_TRUE(isSolid(mesh));
  // Plain parts are flat faces, cut up to no more than 12 mm.
  EXPECT_GT(mesh.triangles.size(), 500u);
  EXPECT_LT(std::filesystem::file_size(fileOf(GetParam().first)), 400000u);
}

TEST_P(ShippedPartTest, HasTheSymmetryOfTheTable) {
  EXPECT_EQ(symmetryName(findSymmetries(meshOf(GetParam().first))), GetParam().second);
}

INSTANTIATE_TEST_SUITE_P(Models, ShippedPartTest, testing::ValuesIn(kParts), [](const auto& test) {
  std::string name = test.param.first;
  std::replace(name.begin(), name.end(), '/', '_');
  return name;
});

TEST(ShippedPartsTest, AreAllHereAndEachInOneSet) {
  std::set<std::string> listed;
  for (const Part& part : kParts) listed.insert(fileOf(part.first).string());
  std::set<std::string> names;
  const std::filesystem::path models(RP_MODELS_DIR);
  for (const auto& entry : std::filesystem::recursive_directory_iterator(models)) {
    if (entry.path().extension() != ".ply") continue;
    EXPECT_EQ(listed.count(entry.path().string()), 1u) << entry.path() << " is not checked here";
    EXPECT_TRUE(names.insert(entry.path().stem().string()).second)
        << entry.path().stem() << " is in two sets: reported on what was chosen on it";
  }
  EXPECT_EQ(names.size(), listed.size());
}

TEST(ShippedPartsTest, TheAngleIsThePlatesOfTheBracket) {
  const auto under_rib_or_boss = [](const glm::dvec3& p) {
    const bool rib = p.y > 5.9 && p.y < 12.1 && p.x > 5.9 && p.z > 5.9;
    const bool boss = p.z > 5.9 && glm::distance(glm::dvec2(p), glm::dvec2(38.0, 47.0)) < 9.1;
    return rib || boss;
  };
  const Mesh angle = meshOf("fitting/angle");
  EXPECT_LT(farthest(angle, 0.0, meshOf("bracket"), under_rib_or_boss), 1e-3);
  for (const glm::vec3& vertex : angle.vertices)
    EXPECT_TRUE(vertex.x < 12.01f || vertex.z < 6.01f) << "rib or boss is still there";
}

// The tips lie on each other; what is left out is the head, and the surface about the cross hole.
TEST(ShippedPartsTest, APinWithoutItsHeadIsAPieceOfARod) {
  const auto head = [](const glm::dvec3& p) { return p.z < 4.1; };
  EXPECT_LT(farthest(meshOf("fitting/pin"), 100.0, meshOf("fitting/rod"), head), 0.03);
  const auto head_or_hole = [](const glm::dvec3& p) {
    return p.z < 6.1 || glm::length(glm::dvec2(p.x, p.z - 62.0)) < 2.4;
  };
  const Mesh dowel = meshOf("reporting/dowel");
  EXPECT_LT(farthest(meshOf("reporting/clevis_pin"), 80.0, dowel, head_or_hole), 0.03);
}

}  // namespace
}  // namespace rangepose
