// rangepose simulate: bins of parts by physics, scanned, as a data set with its truth.
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <charconv>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <system_error>
#include <vector>

#include "core/error.h"
#include "core/parallel.h"
#include "rangepose/bin_simulator.h"
#include "rangepose/command.h"
#include "rangepose/console.h"
#include "rangepose/progress.h"

namespace rangepose::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* kExamples = R"(Examples:
  rangepose simulate models/elbow.ply -o bins
  rangepose simulate a.stl b.stl -o bins --mixed --bins 20 --count 40 --sensor rough
  rangepose simulate part.obj -o bins --unit m --orthographic --sensor none
  rangepose simulate part.stl -o bins --sensor realsense-d435 --camera-distance 600 --emptying 5
Writes the BOP layout: DIR/models, DIR/test/NNNNNN (one bin a scene) with poses,
visible fractions and the bin, and DIR/test_targets_bop19.json. The same seed gives the same files,
whatever the number of threads. When interrupted, the bins that are there are whole.)";

/// The numbers of "640x480"; none where the text is anything else.
template <typename Number>
std::vector<Number> sizesIn(const std::string& text, std::size_t count) {
  std::vector<Number> sizes(count);
  const char* at = text.data();
  const char* const end = at + text.size();
  for (std::size_t k = 0; k < count; ++k) {
    if (k > 0 && (at == end || *at++ != 'x')) return {};
    const auto [next, failure] = std::from_chars(at, end, sizes[k]);
    if (failure != std::errc()) return {};
    at = next;
  }
  return at == end ? sizes : std::vector<Number>();
}

std::string checkImageSize(const std::string& text) {
  const std::vector<int> sizes = sizesIn<int>(text, 2);
  const auto isWrong = [](int size) { return size < 8 || size > 8192; };
  if (!sizes.empty() && std::none_of(sizes.begin(), sizes.end(), isWrong)) return {};
  return text + " is not WIDTHxHEIGHT with 8 to 8192 pixels each";
}

std::string checkBinSize(const std::string& text) {
  const std::vector<double> sizes = sizesIn<double>(text, 3);
  const auto isWrong = [](double size) { return !(size > 0.0) || size > 1e5; };
  if (!sizes.empty() && std::none_of(sizes.begin(), sizes.end(), isWrong)) return {};
  return text + " is not XxYxZ in millimetres";
}

std::atomic<bool> interrupted{false};

/// While it lives an interrupt lets the bins in work end; a second one ends the program.
class InterruptGuard {
 public:
  InterruptGuard() {
    struct sigaction action = {};
    action.sa_handler = [](int) { interrupted = true; };
    action.sa_flags = SA_RESETHAND;
    sigaction(SIGINT, &action, &before_);
  }
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;
  ~InterruptGuard() { sigaction(SIGINT, &before_, nullptr); }

 private:
  struct sigaction before_ = {};
};

/// Makes the folder; what is in it must not mix with what will be.
void checkFolder(const fs::path& out) {
  const std::string label = "output folder " + out.string();
  std::error_code failure;
  fs::create_directories(out, failure);
  if (failure || !fs::is_directory(out, failure)) {
    throw Error(label + ": cannot be made; choose another one");
  }
  if (!fs::is_empty(out, failure) || failure) {
    throw Error(label + ": is not empty; name a new folder");
  }
  checkOutputFile(out / "camera.json");
}

/// What the command line says of scanner and bin, put where the library takes it.
void takeOptions(SimulateArguments& arguments) {
  if (arguments.scanner.orthographic && needsPinhole(sensorModel(arguments.sensor))) {
    throw UsageError("--sensor " + arguments.sensor +
                     " takes no orthographic images; leave out --orthographic");
  }
  if (!arguments.size.empty()) {
    const std::vector<int> pixels = sizesIn<int>(arguments.size, 2);
    arguments.scanner.width = pixels.at(0);
    arguments.scanner.height = pixels.at(1);
  }
  arguments.scanner.tilt_rad = arguments.tilt_deg * 3.14159265358979323846 / 180.0;
  if (!arguments.bin_size.empty()) {
    const std::vector<double> sides = sizesIn<double>(arguments.bin_size, 3);
    arguments.drop.bin.inner_mm = {sides.at(0), sides.at(1), sides.at(2)};
  }
}

int simulate(SimulateArguments& arguments) {
  const auto begin = std::chrono::steady_clock::now();
  setThreadCount(arguments.threads);
  takeOptions(arguments);
  BinSimulator simulator(arguments);
  checkFolder(arguments.out);
  const InterruptGuard guard;
  simulator.writeModels();
  {
    Progress progress(std::cerr, "bins", arguments.bins, terminalProgress());
    std::atomic<int> done{0};
    parallelFor(arguments.bins, 1, [&](int first, int last) {
      for (int bin = first; bin < last && !interrupted; ++bin) {
        simulator.makeBin(bin, interrupted);
        progress.update(++done);
      }
    });
  }
  if (interrupted) {
    throw Error(fmt::format("interrupted; {} of {} bins are in {}, each of them whole",
                            simulator.scenes(),
                            arguments.bins,
                            arguments.out));
  }
  simulator.finish();
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
  std::cout << fmt::format("{}: {} bin{} of {} part{}, {:.2f} s\n",
                           arguments.out,
                           arguments.bins,
                           arguments.bins == 1 ? "" : "s",
                           arguments.count,
                           arguments.count == 1 ? "" : "s",
                           seconds.count());
  return kDone;
}

/// All sensors, what each is in a few words.
std::string sensorHelp() {
  std::string text = "What takes the images:";
  for (const std::string& name : sensorNames()) {
    text += fmt::format("\n{} ({})", name, sensorSummary(name));
  }
  return text;
}

void declareBins(CLI::App& command, SimulateArguments& arguments) {
  command.add_option("--bins", arguments.bins, "Bins to make, a scene each")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  command.add_option("--count", arguments.count, "Parts in each bin")
      ->check(CLI::Range(1, 500))
      ->capture_default_str();
  command
      .add_option("--emptying",
                  arguments.images,
                  "Images of each bin, from which the highest parts are taken meanwhile")
      ->check(CLI::Range(1, 500))
      ->capture_default_str();
  command.add_flag(
      "--wear",
      arguments.wear,
      "Parts differ a little from their models: size, edges, closed holes, lost faces");
  command.add_option("--seed", arguments.seed, "Same seed, same files")->capture_default_str();
  command.add_flag(
      "--mixed", arguments.mixed, "All models in each bin; else one model a bin in turn");
  command
      .add_option(
          "--bin-size", arguments.bin_size, "Inside of the bin [mm]; else as the parts need it")
      ->check(checkBinSize)
      ->option_text("XxYxZ");
}

void declareScanner(CLI::App& command, SimulateArguments& arguments) {
  command.add_option("--sensor", arguments.sensor, sensorHelp())
      ->check(CLI::IsMember(sensorNames()))
      ->option_text("NAME")
      ->capture_default_str();
  command.add_flag(
      "--orthographic", arguments.scanner.orthographic, "Parallel rays; no projector's shadow");
  command.add_option("--size", arguments.size, "Of the image [px]; else that of the sensor")
      ->check(checkImageSize)
      ->option_text("WIDTHxHEIGHT");
  command
      .add_option("--camera-distance",
                  arguments.scanner.distance_mm,
                  "To the middle of the bin [mm]; 0: as near as the sensor allows with all of the "
                  "bin in the image")
      ->check(CLI::Range(0.0, 1e5))
      ->capture_default_str();
  command.add_option("--tilt", arguments.tilt_deg, "Of the view from straight down [degrees]")
      ->check(CLI::Range(0.0, 57.0))
      ->capture_default_str();
}

}  // namespace

std::function<int()> declareSimulate(CLI::App& command) {
  const auto arguments = std::make_shared<SimulateArguments>();
  arguments->scanner.distance_mm = 0.0;
  command.footer(kExamples);
  command
      .add_option("models",
                  arguments->models,
                  "Meshes: PLY, STL, OBJ, OFF, glTF ...; ids 1, 2, ... in this order")
      ->required()
      ->option_text("MODEL...");
  command.add_option("-o,--out", arguments->out, "New folder to write to")
      ->required()
      ->option_text("DIR");
  declareBins(command, *arguments);
  declareScanner(command, *arguments);
  command.add_option("--unit", arguments->unit, "Of the meshes")
      ->check(CLI::IsMember({"mm", "m", "inch"}))
      ->capture_default_str();
  command.add_option("--threads", arguments->threads, "Of the host; 0: all cores")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  return [arguments] { return simulate(*arguments); };
}

}  // namespace rangepose::cli
