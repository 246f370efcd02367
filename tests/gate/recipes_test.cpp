// The bins of the gate. Where a part that was tuned on is reported on, users are promised too much.
#include "gate/recipes.h"

#include <gmock/gmock.h>

#include <set>

#include "core/error.h"
#include "gate/short_check.h"
#include "gate/simulation.h"
#include "support/temp_folder.h"

namespace rangepose::gate {
namespace {

const char* const kCommitted = RP_SOURCE_DIR "/tools/gate/bins.json";
const char* const kShort = RP_SOURCE_DIR "/tests/gate/short.json";

std::string recipes(const std::string& sets) {
  return R"({"sensors":[{"name":"tof"},{"name":"stereo","distance_mm":700}],"sets":[)" + sets +
         "]}";
}

std::string set(const std::string& name, int seed, const std::string& kinds) {
  return R"({"name":")" + name + R"(","seed":)" + std::to_string(seed) + R"(,"kinds":[)" + kinds +
         "]}";
}

std::string messageOf(const std::string& json) {
  try {
    parseRecipes(json, "bins x.json");
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(Recipes, AreReadWhole) {
  const Recipes read = parseRecipes(recipes(set("a",
                                                300,
                                                R"({"name":"one","parts":["x/a"]},
                     {"name":"two","parts":["x/a"],"others":["b"],"mixed":true,"count":7,"bins":3,
                      "emptying":5,"wear":true})")),
                                    "here");
  EXPECT_EQ(read.sensor("stereo").distance_mm, 700.0);
  EXPECT_EQ(read.sensor("tof").distance_mm, 0.0);
  const BinSet& a = read.set("a");
  EXPECT_EQ(a.seed, 300u);
  EXPECT_THAT(a.parts(), testing::ElementsAre("b", "x/a"));
  ASSERT_EQ(a.kinds.size(), 2u);
  EXPECT_EQ(a.kinds[0].count, 25);
  EXPECT_EQ(a.kinds[0].bins, 4);
  EXPECT_EQ(a.kinds[0].seed, 300u);
  EXPECT_EQ(a.kinds[1].seed, 301u) << "else two kinds of one part have the same bins";
  EXPECT_TRUE(a.kinds[1].mixed && a.kinds[1].wear && !a.kinds[1].none);
  EXPECT_EQ(a.kinds[1].emptying, 5);
}

TEST(Recipes, APartMayBeInOneSetOnly) {
  const std::string one = set("fit", 100, R"({"name":"k","parts":["a"],"others":["b"]})");
  EXPECT_THAT(
      messageOf(recipes(one + "," + set("report", 300, R"({"name":"k","parts":["b"]})"))),
      testing::AllOf(testing::HasSubstr("part \"b\""), testing::HasSubstr("sets fit and report")));
  EXPECT_EQ(messageOf(recipes(one + "," + set("report", 300, R"({"name":"k","parts":["c"]})"))),
            "no error");
}

TEST(Recipes, ASeedMayBeInOneSetOnly) {
  const std::string one = set("fit", 100, R"({"name":"k","parts":["a"]})");
  EXPECT_THAT(messageOf(recipes(one + "," + set("report", 199, R"({"name":"k","parts":["b"]})"))),
              testing::HasSubstr("seeds of the sets fit and report"));
  EXPECT_EQ(messageOf(recipes(one + "," + set("report", 200, R"({"name":"k","parts":["b"]})"))),
            "no error");
}

TEST(Recipes, WhatIsUnknownIsNamed) {
  EXPECT_THAT(messageOf(recipes(set("a", 1, R"({"name":"k","parts":["a"],"emptied":3})"))),
              testing::AllOf(testing::HasSubstr("bins x.json set 1 kind 1"),
                             testing::HasSubstr("\"emptied\" is unknown"),
                             testing::HasSubstr("emptying")));
  EXPECT_THAT(messageOf(R"({"sensors":[],"sets":[],"parts":[]})"),
              testing::HasSubstr("\"parts\" is unknown"));
  EXPECT_THAT(messageOf(R"({"sensors":[{"name":"tof","distance":3}],"sets":[]})"),
              testing::HasSubstr("\"distance\" is unknown"));
}

TEST(Recipes, WhatIsWrongIsNamed) {
  const auto ofKind = [](const std::string& kind) { return messageOf(recipes(set("a", 1, kind))); };
  EXPECT_THAT(ofKind(R"({"name":"k"})"), testing::HasSubstr("\"parts\""));
  EXPECT_THAT(ofKind(R"({"name":"k","parts":["a"],"count":0})"), testing::HasSubstr("\"count\""));
  EXPECT_THAT(ofKind(R"({"name":"k","parts":["a"],"count":2.5})"), testing::HasSubstr("\"count\""));
  EXPECT_THAT(ofKind(R"({"name":"k","parts":["a"],"mixed":1})"), testing::HasSubstr("\"mixed\""));
  EXPECT_THAT(ofKind(R"({"name":"k","parts":["a"],"none":true})"), testing::HasSubstr("others"));
  EXPECT_THAT(ofKind(R"({"name":"k","parts":["a"],"others":["a"]})"), testing::HasSubstr("twice"));
  EXPECT_THAT(ofKind(R"({"name":"k","parts":["../a"]})"), testing::HasSubstr("\"../a\""))
      << "another way to write a part must not hide it from the check";
  EXPECT_THAT(ofKind(R"({"name":"k","parts":["a"]},{"name":"k","parts":["b"]})"),
              testing::HasSubstr("\"k\" is there twice"));
  EXPECT_THAT(messageOf(recipes(R"({"name":"a","seed":1,"kinds":[]})")),
              testing::HasSubstr("\"kinds\""));
  EXPECT_THAT(messageOf("{"), testing::HasSubstr("not valid JSON"));
}

TEST(Recipes, NamesThatAreNotThereAreTold) {
  const Recipes read = parseRecipes(recipes(set("fit", 1, R"({"name":"k","parts":["a"]})")), "x");
  EXPECT_THROW(read.set("report"), Error);
  try {
    read.sensor("lidar");
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("tof, stereo"));
  }
}

TEST(Recipes, CommittedSetsShareNothing) {
  const Recipes read = readRecipes(kCommitted);
  std::set<std::string> seen;
  for (const char* name : {"fit", "choose", "report"}) {
    for (const std::string& part : read.set(name).parts()) {
      EXPECT_TRUE(seen.insert(part).second) << part;
    }
  }
  for (const std::string& part : read.set("report").parts()) {
    EXPECT_THAT(part, testing::StartsWith("reporting/"));
  }
  for (const std::string& part : read.set("choose").parts()) {
    EXPECT_THAT(part, testing::StartsWith("tuning/"));
  }
}

TEST(Recipes, ShortGateTouchesNoPartOfAnotherSetThanFitAndNoSeed) {
  const Recipes committed = readRecipes(kCommitted);
  const ShortGate gate = readShortGate(kShort);
  const BinSet& bins = gate.recipes.sets.front();
  const std::vector<std::string> fit = committed.set("fit").parts();
  EXPECT_THAT(fit, testing::IsSupersetOf(bins.parts()));
  for (const BinSet& other : committed.sets) {
    const auto [low, high] = std::minmax(bins.seed, other.seed);
    EXPECT_GE(high - low, kSeedsOfSet) << other.name;
  }
}

class Simulations : public testing::Test {
 protected:
  Simulations() {
    for (const char* part : {"a", "b", "c"}) folder_.write(std::string(part) + ".ply", "ply\n");
    set_.name = "s";
    set_.seed = 40;
    kind_.parts = {"a", "b"};
    kind_.others = {"c"};
    kind_.seed = 42;
    set_.kinds = {kind_};
  }
  std::vector<std::string> namesOf(const Simulation& simulation) const {
    std::vector<std::string> names;
    for (const auto& model : simulation.models) names.push_back(model.stem().string());
    return names;
  }

  test::TempFolder folder_;
  BinSet set_;
  BinKind kind_;
};

TEST_F(Simulations, PartsOfTheDatabaseComeFirst) {
  const Simulation simulation = simulationOf(set_, kind_, {"tof"}, folder_.path());
  EXPECT_THAT(namesOf(simulation), testing::ElementsAre("a", "b", "c"));
  EXPECT_THAT(simulation.options, testing::IsSupersetOf({"--sensor", "tof", "--seed", "42"}));
  EXPECT_THAT(simulation.options, testing::Not(testing::Contains("--camera-distance")));
  EXPECT_THAT(simulation.options, testing::Not(testing::Contains("--mixed")));
  kind_.none = true;
  EXPECT_THAT(namesOf(simulationOf(set_, kind_, {"tof"}, folder_.path())),
              testing::ElementsAre("c"));
}

TEST_F(Simulations, TinyBinHasTheSameSensorAndOptions) {
  kind_.wear = true;
  kind_.emptying = 6;
  const Simulation tiny = tinySimulation(set_, kind_, {"stereo", 700.0}, folder_.path());
  EXPECT_THAT(namesOf(tiny), testing::ElementsAre("a"));
  EXPECT_THAT(tiny.options,
              testing::IsSupersetOf(
                  {"--sensor", "stereo", "--wear", "--emptying", "--camera-distance", "700"}));
  EXPECT_THAT(tiny.options, testing::Not(testing::Contains("--size")))
      << "too few pixels to differ";
}

TEST_F(Simulations, MissingMeshIsNamed) {
  kind_.others = {"d"};
  EXPECT_THROW(simulationOf(set_, kind_, {"tof"}, folder_.path()), Error);
}

}  // namespace
}  // namespace rangepose::gate
