// rangepose_device_bench: every stage on every path of this machine, as a Markdown table.
//   rangepose_device_bench [--views 1024] [--starts 3] [--runs 50] [--out FILE]
//   rangepose_device_bench --paths      names the paths with their interop, measures nothing
// Paths that are not here are left out and named. Exit code 1: a path failed, or differs from the
// host by more than its tolerance; the report says which.
#include <fstream>
#include <functional>
#include <iostream>
#include <sstream>
#include <string>

#include "compare/compare.h"
#include "device_bench/rows.h"
#include "gles/stage_set_gles.h"
#include "pipeline/path_choice.h"

namespace rangepose::device_bench {
namespace {

struct Arguments {
  int views = 1024;
  int starts = 3;
  int runs = 50;
  std::string out;
  bool paths_only = false;
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
  if (argc == 2 && std::string(argv[1]) == "--paths") {
    arguments.paths_only = true;
    return arguments;
  }
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

struct CudaVariant {
  std::string name;
  cuda::PathOptions options;
};

std::vector<CudaVariant> cudaVariants() {
  return {{"cuda, fused", {}},
          {"cuda, staged", {cuda::Interop::kAuto, true}},
          {"cuda, copies", {cuda::Interop::kCopy, false}}};
}

std::string lineOf(const CudaVariant& variant, const cuda::Path& path) {
  return "- " + variant.name + ": interop " + cuda::nameOf(path.interop) + ", " +
         path.interop_note + "\n";
}

std::string lineOf(const gles::ContextInfo& glsl) {
  return "- glsl: " + glsl.renderer + ", " + glsl.version + "\n";
}

/// `work`, and a line that says so where it does not get through. True where that is a failure:
/// what is not here is none.
bool tried(const std::string& name, std::string& lines, const std::function<void()>& work) {
  try {
    work();
  } catch (const Unavailable& error) {
    lines += "- " + name + ": not here (" + error.what() + ")\n";
  } catch (const Error& error) {
    lines += "- " + name + ": failed: " + error.what() + "\n";
    return true;
  }
  return false;
}

bool printPaths() {
  std::string lines;
  bool failed = tried("glsl", lines, [&] { lines += lineOf(gles::Context().info()); });
  for (const CudaVariant& variant : cudaVariants()) {
    failed |= tried(
        variant.name, lines, [&] { lines += lineOf(variant, cuda::openPath(variant.options)); });
  }
  std::cout << lines;
  return failed;
}

class Report {
 public:
  explicit Report(const Arguments& arguments)
      : arguments_(arguments), load_(arguments.views, arguments.starts) {}

  /// True: a path failed or differs. What is measured is written after each path: the next one may
  /// take the process with it.
  bool run() {
    const std::unique_ptr<StageSet> host = makeHostStages();
    attempt("host", [&] { measure({"host", host.get(), false, false, nullptr}); });
    attempt("glsl", [&] { withGlsl(*host); });
    for (const CudaVariant& variant : cudaVariants())
      attempt(variant.name, [&] { withCuda(*host, variant); });
    attempt("kernels alone", [&] { kernels(); });
    if (arguments_.out.empty()) std::cout << text();
    return failed_;
  }

 private:
  static constexpr const char* kCounted =
      "Times of a path are wall times of a call with its transfers; \"kernels alone\" are events "
      "on "
      "the device. Bytes must be read and written once, operations are counted in the formulas "
      "(reference pixels that the simplexes evaluate, 17 operations each). Shares are of the "
      "ceilings measured here.\n";

  std::string text() const {
    return "Elbow of models/, heap of 14 in 640x480, " + std::to_string(arguments_.views) +
           " views of " + std::to_string(kSizePx) + "x" + std::to_string(kSizePx) + " px, " +
           std::to_string(arguments_.starts) + " starts.\n\n" + lines_ + "\n" +
           markdownTable(rows_, ceilings_) + "\n" + kCounted + comparisons_;
  }
  void write() const {
    if (arguments_.out.empty()) return;
    std::ofstream file(arguments_.out);
    file << text();
    file.close();
    if (!file) throw Error(arguments_.out + ": cannot be written");
  }
  void attempt(const std::string& name, const std::function<void()>& work) {
    failed_ |= tried(name, lines_, work);
    write();
  }
  void measure(const BenchPath& path) {
    std::cerr << "measuring " << path.name << '\n';
    for (const Row& row : stageRows(load_, path, arguments_.runs)) rows_.push_back(row);
  }
  void compare(StageSet& host, StageSet& subject, const std::string& name) {
    const Comparison comparison =
        comparePaths(load_.depth, std::nullopt, load_.database, load_.options, host, subject);
    comparisons_ += "\n## host and " + name + "\n```\n" + comparisonTable(comparison) + "```\n";
    if (!comparison.first_out_of_tolerance) return;
    throw Error("differs from the host: " + *comparison.first_out_of_tolerance);
  }
  void withGlsl(StageSet& host) {
    gles::Context context;
    lines_ += lineOf(context.info());
    const std::unique_ptr<StageSet> stages = gles::makeGlesStages(context);
    const bool software = context.info().software;
    measure({"glsl", stages.get(), !software, software, nullptr});
    if (!software) compare(host, *stages, "glsl");
  }
  void withCuda(StageSet& host, const CudaVariant& variant) {
    const cuda::Path path = cuda::openPath(variant.options);
    lines_ += lineOf(variant, path);
    BenchPath bench{variant.name, path.stages.get(), true, false, nullptr};
#ifdef RP_HAVE_CUDA
    bench.wait = waitForDevice;
#endif
    measure(bench);
    compare(host, *path.stages, variant.name);
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
    lines_ += line.str();
#endif
  }

  const Arguments arguments_;
  Workload load_;
  std::vector<Row> rows_;
  Ceilings ceilings_;
  std::string lines_;
  std::string comparisons_;
  bool failed_ = false;
};

int run(int argc, char** argv) {
  const Arguments arguments = parse(argc, argv);
  const bool failed = arguments.paths_only ? printPaths() : Report(arguments).run();
  return failed ? 1 : 0;
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
