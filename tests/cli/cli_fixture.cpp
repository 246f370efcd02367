#include "cli/cli_fixture.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <stdexcept>

namespace rangepose::test {
namespace fs = std::filesystem;

bool CliTest::cudaWorks() const {
  static const bool kWorks =
      run({"doctor"}).out.find("\n  cuda              yes") != std::string::npos;
  return kWorks;
}

std::string CliTest::smallDatabase() const {
  const RunResult built = run({"build",
                               (kModels / "bolt.ply").string(),
                               "-o",
                               "small.rpdb",
                               "--views",
                               "60",
                               "--size",
                               "32",
                               "--path",
                               "host"});
  if (built.exit_code != 0) throw std::runtime_error(built.err);
  return "small.rpdb";
}

std::string CliTest::elbowDatabase() const {
  if (fs::exists(folder() / "elbow.rpdb")) return "elbow.rpdb";
  const RunResult built = run({"build",
                               (kModels / "elbow.ply").string(),
                               "-o",
                               "elbow.rpdb",
                               "--views",
                               "400",
                               "--path",
                               "host"});
  if (built.exit_code != 0) throw std::runtime_error(built.err);
  return "elbow.rpdb";
}

std::set<std::string> CliTest::files() const {
  std::set<std::string> names;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder())) {
    if (!entry.is_directory()) names.insert(fs::relative(entry.path(), folder()).string());
  }
  return names;
}

std::vector<std::string> CliTest::demoArguments(const std::vector<std::string>& more) const {
  std::vector<std::string> arguments = {"estimate",
                                        "--db",
                                        elbowDatabase(),
                                        "--depth",
                                        (kModels / "demo/depth.png").string(),
                                        "--camera",
                                        (kModels / "demo/camera.json").string()};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

std::string readText(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

::testing::AssertionResult failsWith(const RunResult& result,
                                     int exit_code,
                                     const std::vector<std::string>& words) {
  const auto wrong = [&result](const std::string& what) {
    return ::testing::AssertionFailure()
           << what << "\nexit code " << result.exit_code << "\nstdout: " << result.out
           << "\nstderr: " << result.err;
  };
  if (result.exit_code != exit_code)
    return wrong("expected exit code " + std::to_string(exit_code));
  if (!result.out.empty()) return wrong("expected nothing on stdout");
  if (result.err.rfind("rangepose: ", 0) != 0)
    return wrong("stderr does not begin with rangepose:");
  if (std::count(result.err.begin(), result.err.end(), '\n') != 1 || result.err.back() != '\n') {
    return wrong("expected one line on stderr");
  }
  for (const std::string& word : words) {
    if (result.err.find(word) == std::string::npos) return wrong("stderr does not say: " + word);
  }
  return ::testing::AssertionSuccess();
}

}  // namespace rangepose::test
