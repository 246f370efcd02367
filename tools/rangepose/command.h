// What the subcommands share: how they are declared, and how they end.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <stdexcept>

namespace rangepose::cli {

enum ExitCode : int { kDone = 0, kFailed = 1, kUsage = 2, kUnavailable = 3 };

/// The options contradict each other or one is missing; the text is one line.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Declares the options of a subcommand; returns what runs it and gives the exit code. The options
/// are held by the function.
using Declare = std::function<int()> (*)(CLI::App& command);

std::function<int()> declareDoctor(CLI::App& command);
std::function<int()> declareBuild(CLI::App& command);
std::function<int()> declareSimulate(CLI::App& command);
std::function<int()> declareEstimate(CLI::App& command);
std::function<int()> declareCompare(CLI::App& command);
std::function<int()> declareEvaluate(CLI::App& command);

}  // namespace rangepose::cli
