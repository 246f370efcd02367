// What the gate keeps. Where something old is read as new, a change seems to do nothing.
#include "gate/cache.h"

#include <gmock/gmock.h>
#include <sys/stat.h>

#include <fstream>
#include <iterator>

#include "core/error.h"
#include "gate/content_hash.h"
#include "gate/process.h"
#include "support/temp_folder.h"

namespace rangepose::gate {
namespace {

namespace fs = std::filesystem;

std::string textOf(const fs::path& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// A program of these lines of shell.
fs::path script(const test::TempFolder& folder, const std::string& name, const std::string& lines) {
  fs::path file = folder.write(name, "#!/bin/sh\n" + lines + "\n");
  chmod(file.c_str(), 0755);
  return file;
}

/// Stands for rangepose: writes `bytes` as the one file of a data set, database or result, and a
/// line for each call into calls.txt.
fs::path program(const test::TempFolder& folder,
                 const std::string& name,
                 const std::string& bytes) {
  return script(folder,
                name,
                "# " + name + "\necho $1 >> " + (folder.path() / "calls.txt").string() +
                    R"(
command=$1
while [ $# -gt 0 ]; do
  case $1 in --out|--csv) out=$2 ;; esac
  shift
done
if [ $command = simulate ]; then mkdir "$out" && out=$out/bin; fi
echo ')" + bytes + R"(' > "$out")");
}

class CacheTest : public testing::Test {
 protected:
  CacheTest() {
    mesh_ = folder_.write("a.ply", "ply 1");
    simulation_ = {{mesh_}, {"--sensor", "tof", "--count", "25"}};
    tiny_ = {{mesh_}, {"--sensor", "tof", "--count", "3"}};
  }
  fs::path cacheFolder() const { return folder_.path() / "cache"; }
  std::string calls() const { return textOf(folder_.path() / "calls.txt"); }
  fs::path dataSet(const fs::path& simulator) const {
    Cache cache(cacheFolder(), 1);
    return cache.dataSet(simulator, simulation_, tiny_);
  }

  test::TempFolder folder_;
  fs::path mesh_;
  Simulation simulation_;
  Simulation tiny_;
};

TEST_F(CacheTest, BinsAreMadeOnce) {
  const fs::path simulator = program(folder_, "sim", "depth");
  const fs::path made = dataSet(simulator);
  EXPECT_EQ(textOf(made / "bin"), "depth\n");
  EXPECT_EQ(calls(), "simulate\nsimulate\n") << "the tiny bin and the bins";
  EXPECT_EQ(dataSet(simulator), made);
  EXPECT_EQ(calls(), "simulate\nsimulate\n");
}

TEST_F(CacheTest, AnotherProgramWithTheSameScannerKeepsTheBins) {
  const fs::path made = dataSet(program(folder_, "sim", "depth"));
  EXPECT_EQ(dataSet(program(folder_, "sim2", "depth")), made);
  EXPECT_EQ(calls(), "simulate\nsimulate\nsimulate\n") << "a tiny bin by the other program";
}

TEST_F(CacheTest, AChangedScannerMakesThemAnew) {
  const fs::path made = dataSet(program(folder_, "sim", "depth"));
  const fs::path anew = dataSet(program(folder_, "sim", "other depth"));
  EXPECT_NE(anew, made);
  EXPECT_EQ(textOf(anew / "bin"), "other depth\n");
}

TEST_F(CacheTest, ChangedMeshOrOptionsMakeThemAnew) {
  const fs::path simulator = program(folder_, "sim", "depth");
  const fs::path made = dataSet(simulator);
  folder_.write("a.ply", "ply 2");
  const fs::path of_mesh = dataSet(simulator);
  EXPECT_NE(of_mesh, made);
  simulation_.options.back() = "26";
  EXPECT_NE(dataSet(simulator), of_mesh);
}

TEST_F(CacheTest, BinsThatWereNotFinishedAreMadeAnew) {
  const fs::path simulator = program(folder_, "sim", "depth");
  const fs::path made = dataSet(simulator);
  fs::remove_all(made);
  fs::create_directories(made.string() + ".part");
  std::ofstream(made.string() + ".part/half") << "x";
  EXPECT_EQ(dataSet(simulator), made);
  EXPECT_FALSE(fs::exists(made / "half"));
}

TEST_F(CacheTest, DatabasesAndAnswersAreThoseOfTheProgram) {
  const fs::path one = program(folder_, "one", "1");
  const fs::path two = program(folder_, "two", "2");
  Cache cache(cacheFolder(), 1);
  const fs::path data_set = folder_.path();
  const fs::path database_1 = cache.database(one, {mesh_});
  const fs::path database_2 = cache.database(two, {mesh_});
  EXPECT_NE(database_1, database_2);
  const fs::path answers_1 = cache.answers(one, {"estimate"}, database_1, data_set);
  EXPECT_EQ(textOf(answers_1), "1\n");
  EXPECT_EQ(textOf(cache.answers(two, {"estimate"}, database_2, data_set)), "2\n");
  EXPECT_EQ(cache.answers(one, {"estimate"}, database_1, data_set), answers_1);
  EXPECT_NE(cache.answers(one, {"estimate", "--all"}, database_1, data_set), answers_1);
  EXPECT_EQ(calls(), "build\nbuild\nestimate\nestimate\nestimate\n");
}

TEST_F(CacheTest, OneRunAtATime) {
  const Cache cache(cacheFolder(), 1);
  EXPECT_THROW(Cache(cacheFolder(), 1), Error);
}

TEST_F(CacheTest, AFailureNamesTheLogAndItsLastLine) {
  const fs::path failing = script(folder_, "bad", "echo first; echo no such option >&2; exit 2");
  try {
    dataSet(failing);
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(),
                testing::AllOf(testing::HasSubstr("bad simulate failed with exit code 2"),
                               testing::HasSubstr("cache/logs/tiny-"),
                               testing::HasSubstr("no such option")));
  }
  EXPECT_TRUE(fs::is_empty(cacheFolder() / "bins"));
}

TEST(RunLogged, AProgramThatIsNotThereIsNamed) {
  const test::TempFolder folder;
  try {
    runLogged({(folder.path() / "nothing").string()}, folder.path() / "log");
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("nothing: cannot be started"));
  }
}

TEST(ContentHashes, TellBytesNamesAndBoundsApart) {
  const test::TempFolder folder;
  EXPECT_NE(ContentHash().add("ab").add("c").text(), ContentHash().add("a").add("bc").text());
  folder.write("one/x", "1");
  folder.write("two/y", "1");
  folder.write("three/x", "2");
  const auto of = [&](const char* name) {
    return ContentHash().addFolder(folder.path() / name).text();
  };
  EXPECT_NE(of("one"), of("two"));
  EXPECT_NE(of("one"), of("three"));
  folder.write("four/x", "1");
  EXPECT_EQ(of("one"), of("four"));
  EXPECT_THROW(ContentHash().addFile(folder.path() / "none"), Error);
}

}  // namespace
}  // namespace rangepose::gate
