// Registration and counters that all benchmarks share.
#pragma once

#include <benchmark/benchmark.h>

#include <functional>
#include <string>

namespace rangepose::bench {

/// Measured in wall time, because the host path uses all cores and shaders run elsewhere.
void add(const std::string& name, const std::function<void(::benchmark::State&)>& body);

/// `count` a run, shown as a rate.
void rate(::benchmark::State& state, const char* name, double count);

}  // namespace rangepose::bench
