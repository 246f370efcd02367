// rangepose_device_bench: every stage on every path of this machine, as a Markdown table.
//   rangepose_device_bench [--views 1024] [--starts 3] [--runs 50] [--out FILE]
// Paths that are not here are left out and named.
#include <fstream>
#include <iostream>
#include <sstream>
#include <string>

#include "device_bench/rows.h"
#include "gles/stage_set_gles.h"
#include "pipeline/compare.h"
#include "pipeline/path_choice.h"

namespace rangepose::device_bench {
namespace {

struct Arguments {
  int views = 1024;
  int starts = 3;
  int runs = 50;
  std::string out;
};

int number(const std::string& name, const std::string& text) {
  std::size_t used = 0;
  int value = 0;
  try {
    value = std::stoi(text, &used);
  } catch (const std::exception&) {
    used = 0;
  }
  if (used != text.size() || value < 1) throw Error(name + " needs a whole number from 1 on");
  return value;
}

Arguments parse(int argc, char** argv) {
  Arguments arguments;
  for (int i = 1; i < argc; i += 2) {
    const std::string name = argv[i];
    if (i + 1 >= argc) throw Error(name + " needs a value");
    const std::string value = argv[i + 1];
    if (name == "--views") {
      arguments.views = number(name, value);
    } else if (name == "--starts") {
      arguments.starts = number(name, value);
    } else if (name == "--runs") {
      arguments.runs = number(name, value);
    } else if (name == "--out") {
      arguments.out = value;
    } else {
      throw Error("unknown option " + name);
    }
  }
  return arguments;
}

class Report {
 public:
  explicit Report(const Arguments& arguments)
      : arguments_(arguments), load_(arguments.views, arguments.starts) {}

  std::string run() {
    text_ = "Elbow of models/, heap of 14 in 640x480, " + std::to_string(arguments_.views) +
            " views of " + std::to_string(kSizePx) + "x" + std::to_string(kSizePx) + " px, " +
            std::to_string(arguments_.starts) + " starts.\n\n";
    const std::unique_ptr<StageSet> host = makeHostStages();
    measure({"host", host.get(), false, false});
    withGlsl(*host);
    withCuda(*host, "cuda, fused", {});
    withCuda(*host, "cuda, staged", {cuda::Interop::kAuto, true});
    withCuda(*host, "cuda, copies", {cuda::Interop::kCopy, false});
    kernels();
    return text_ + "\n" + markdownTable(rows_, ceilings_) + "\n" + kCounted + comparisons_;
  }

 private:
  static constexpr const char* kCounted =
      "Times of a path are wall times of a call with its transfers; \"kernels alone\" are events "
      "on "
      "the device. Bytes must be read and written once, operations are counted in the formulas "
      "(reference pixels that the simplexes evaluate, 17 operations each). Shares are of the "
      "ceilings measured here.\n";

  void measure(const BenchPath& path) {
    std::cerr << "measuring " << path.name << '\n';
    for (const Row& row : stageRows(load_, path, arguments_.runs)) rows_.push_back(row);
  }
  void compare(StageSet& host, StageSet& subject, const std::string& name) {
    const Comparison comparison =
        comparePaths(load_.depth, std::nullopt, load_.database, load_.options, host, subject);
    comparisons_ += "\n## host and " + name + "\n```\n" + comparisonTable(comparison) + "```\n";
  }
  void withGlsl(StageSet& host) {
    try {
      gles::Context context;
      const std::unique_ptr<StageSet> stages = gles::makeGlesStages(context);
      text_ += "- glsl: " + context.info().renderer + ", " + context.info().version + "\n";
      const bool software = context.info().software;
      measure({"glsl", stages.get(), !software, software});
      if (!software) compare(host, *stages, "glsl");
    } catch (const Unavailable& error) {
      text_ += "- glsl: not here (" + std::string(error.what()) + ")\n";
    }
  }
  void withCuda(StageSet& host, const std::string& name, const cuda::PathOptions& options) {
    try {
      const cuda::Path path = cuda::openPath(options);
      text_ +=
          "- " + name + ": interop " + cuda::nameOf(path.interop) + ", " + path.interop_note + "\n";
      measure({name, path.stages.get(), true, false});
      compare(host, *path.stages, name);
    } catch (const Unavailable& error) {
      text_ += "- " + name + ": not here (" + std::string(error.what()) + ")\n";
    }
  }
  void kernels() {
#ifdef RP_HAVE_CUDA
    if (!cuda::status().missing.empty()) return;
    std::cerr << "measuring kernels\n";
    for (const Row& row : kernelRows(load_, arguments_.runs)) rows_.push_back(row);
    ceilings_ = measureCeilings();
    std::ostringstream line;
    line << "- ceilings: copy on the device " << ceilings_.bytes_per_s / 1.0e9
         << " GB/s, multiply-adds in float " << ceilings_.operations_per_s / 1.0e12 << " Tflop/s\n";
    text_ += line.str();
#endif
  }

  const Arguments arguments_;
  Workload load_;
  std::vector<Row> rows_;
  Ceilings ceilings_;
  std::string text_;
  std::string comparisons_;
};

int run(int argc, char** argv) {
  const Arguments arguments = parse(argc, argv);
  const std::string text = Report(arguments).run();
  if (arguments.out.empty()) {
    std::cout << text;
    return 0;
  }
  std::ofstream file(arguments.out);
  file << text;
  file.close();
  if (!file) throw Error(arguments.out + ": cannot be written");
  return 0;
}

}  // namespace
}  // namespace rangepose::device_bench

int main(int argc, char** argv) {
  try {
    return rangepose::device_bench::run(argc, argv);
  } catch (const std::exception& error) {
    std::cerr << "rangepose_device_bench: " << error.what() << '\n';
    return 1;
  }
}
