// rangepose_bench: how long the stages and whole frames take. See run.sh.
#include <benchmark/benchmark.h>

#include <exception>
#include <iostream>

#include "bench/fixture.h"

int main(int argc, char** argv) {
  try {
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
    rangepose::bench::Fixture fixture;
    if (fixture.context() == nullptr) {
      std::cerr << "no benchmarks of the glsl path: " << fixture.noGlesReason() << '\n';
    } else {
      benchmark::AddCustomContext("glsl", fixture.context()->info().renderer);
    }
    if (!fixture.noCudaReason().empty()) {
      std::cerr << "no benchmarks of the cuda path: " << fixture.noCudaReason() << '\n';
    }
    registerStageBenchmarks(fixture);
    registerSearchBenchmarks(fixture);
    registerRefineBenchmarks(fixture);
    registerFrameBenchmarks(fixture);
    registerDatabaseBenchmarks(fixture);
    benchmark::RunSpecifiedBenchmarks();
    benchmark::Shutdown();
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "rangepose_bench: " << error.what() << '\n';
    return 1;
  }
}
