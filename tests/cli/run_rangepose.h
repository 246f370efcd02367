// Runs the real executable and keeps what it said.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace rangepose::test {

struct RunResult {
  int exit_code = -1;  ///< 128 + signal where one ended it
  std::string out;
  std::string err;
};

/// Runs any program of the project in the same way.
RunResult runProgram(const std::string& executable,
                     const std::vector<std::string>& arguments,
                     const std::filesystem::path& folder,
                     const std::vector<std::string>& environment = {});

/// Runs rangepose with the arguments, in `folder`, with "NAME=value" added to the environment. No
/// shell is involved.
RunResult runRangepose(const std::vector<std::string>& arguments,
                       const std::filesystem::path& folder,
                       const std::vector<std::string>& environment = {});

/// The same, sent `signal` once `condition` holds; it is asked every millisecond. The run may be
/// over before.
RunResult runRangeposeUntil(const std::function<bool()>& condition,
                            int signal,
                            const std::vector<std::string>& arguments,
                            const std::filesystem::path& folder);

/// Lets no EGL driver be found.
inline const std::vector<std::string> kNoEgl = {"__EGL_VENDOR_LIBRARY_FILENAMES=/nonexistent"};

}  // namespace rangepose::test
