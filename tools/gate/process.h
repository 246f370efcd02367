// Other programs, run one at a time.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace rangepose::gate {

/// Runs words[0] with the other words as arguments, without a shell, and waits. What it says goes
/// to the file `log`. Throws Error, with the last line of the log, where it cannot be started or
/// does not end with exit code 0.
void runLogged(const std::vector<std::string>& words, const std::filesystem::path& log);

}  // namespace rangepose::gate
