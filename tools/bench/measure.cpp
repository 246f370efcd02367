#include "bench/measure.h"

namespace rangepose::bench {

void add(const std::string& name, const std::function<void(::benchmark::State&)>& body) {
#ifndef __clang_analyzer__  // It takes what the library's registry owns for a leak.
  ::benchmark::RegisterBenchmark(name.c_str(), body)
      ->UseRealTime()
      ->Unit(::benchmark::kMillisecond);
#else
  static_cast<void>(name);
  static_cast<void>(body);
#endif
}

void rate(::benchmark::State& state, const char* name, double count) {
  state.counters[name] =
      ::benchmark::Counter(count, ::benchmark::Counter::kIsIterationInvariantRate);
}

}  // namespace rangepose::bench
