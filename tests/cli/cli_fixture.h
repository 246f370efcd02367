// What the command line tests share: a folder of their own, databases, and what a failure must look
// like.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "cli/run_rangepose.h"
#include "support/temp_folder.h"

namespace rangepose::test {

inline const std::filesystem::path kModels = RP_MODELS_DIR;

class CliTest : public ::testing::Test {
 protected:
  RunResult run(const std::vector<std::string>& arguments,
                const std::vector<std::string>& environment = {}) const {
    return runRangepose(arguments, folder(), environment);
  }

  /// A database of the bolt with few and small views; for what needs any database.
  std::string smallDatabase() const;
  /// A database that finds the elbows of the demo; made once for each test.
  std::string elbowDatabase() const;

  std::filesystem::path write(const std::string& name, const std::string& bytes) const {
    return folder_.write(name, bytes);
  }
  /// Paths of all files in the folder, relative to it.
  std::set<std::string> files() const;

  /// --db elbow, --depth and --camera of the demo, and `more`.
  std::vector<std::string> demoArguments(const std::vector<std::string>& more) const;

  /// Whether the CUDA path works here, on a device or an emulated one.
  bool cudaWorks() const;

  const std::filesystem::path& folder() const { return folder_.path(); }

 private:
  TempFolder folder_;
};

std::string readText(const std::filesystem::path& path);

/// The exit code, nothing on stdout, and one line "rangepose: ..." on stderr that has all `words`
/// in it.
::testing::AssertionResult failsWith(const RunResult& result,
                                     int exit_code,
                                     const std::vector<std::string>& words);

}  // namespace rangepose::test
