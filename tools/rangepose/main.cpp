// rangepose: the command line. One subcommand a file; here are their table and the exit codes.
#include <exception>
#include <iostream>
#include <new>
#include <string>
#include <utility>
#include <vector>

#include "core/error.h"
#include "rangepose/command.h"
#include "rangepose/console.h"

namespace rangepose::cli {
namespace {

struct CommandEntry {
  const char* name;
  const char* description;
  Declare declare;
};

constexpr CommandEntry kCommands[] = {
    {"doctor", "What EGL, GL and CUDA find here; which paths work, and why not", declareDoctor},
    {"build", "Makes a reference database from CAD models", declareBuild},
    {"simulate", "Makes bins of parts by physics, scanned, with the truth", declareSimulate},
    {"estimate", "Finds the poses of parts in a depth image", declareEstimate},
    {"compare", "Runs the stages on several paths and shows where they part", declareCompare},
    {"evaluate", "Measures results against the truth, as tables and plots", declareEvaluate},
};

constexpr const char* kFooter =
    "Exit codes: 0 done (no pose found is an answer, too), 1 failed, 2 wrong usage,\n"
    "3 a path that is not available here.\n"
    "rangepose COMMAND --help tells more and shows examples.";

/// Parse errors become UsageError; -1 when a command is to be run, else the exit code.
int parse(CLI::App& app, int argc, char** argv) {
  try {
    app.parse(argc, argv);
    return -1;
  } catch (const CLI::Success& request) {  // --help, --version
    app.exit(request);
    return kDone;
  } catch (const CLI::ParseError& error) {
    std::string help = "rangepose";
    for (const CLI::App* chosen : app.get_subcommands()) help += " " + chosen->get_name();
    // What is unknown is said before what is missing: it is often a misspelled name of just that.
    const std::vector<std::string> unknown = app.remaining(true);
    const std::string what = unknown.empty() ? error.what() : "unknown argument " + unknown.front();
    throw UsageError(what + "; see " + help + " --help");
  }
}

int run(int argc, char** argv) {
  CLI::App app("6-DoF poses of known parts in one depth image.", "rangepose");
  app.set_version_flag("--version", "rangepose " RP_VERSION, "Print the version");
  app.require_subcommand(1);
  app.footer(kFooter);
  app.get_formatter()->column_width(34);
  std::vector<std::pair<CLI::App*, std::function<int()>>> commands;
  for (const CommandEntry& entry : kCommands) {
    CLI::App* command = app.add_subcommand(entry.name, entry.description);
    commands.emplace_back(command, entry.declare(*command));
  }
  int code = parse(app, argc, argv);
  for (const auto& [command, execute] : commands) {
    if (code < 0 && command->parsed()) code = execute();
  }
  std::cout.flush();
  if (!std::cout) throw Error("standard output: cannot be written; is the disk full?");
  return code;
}

}  // namespace
}  // namespace rangepose::cli

int main(int argc, char** argv) {
  using namespace rangepose;
  try {
    return cli::run(argc, argv);
  } catch (const cli::UsageError& error) {
    cli::printError(error.what());
    return cli::kUsage;
  } catch (const Unavailable& error) {
    cli::printError(error.what());
    return cli::kUnavailable;
  } catch (const std::bad_alloc&) {
    cli::printError("out of memory; use a smaller image, fewer views or fewer objects");
    return cli::kFailed;
  } catch (const std::exception& error) {
    cli::printError(error.what());
    return cli::kFailed;
  }
}
