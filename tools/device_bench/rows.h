// The rows of the report.
#pragma once

#include <vector>

#include "device_bench/report.h"
#include "device_bench/workload.h"

namespace rangepose::device_bench {

struct BenchPath {
  std::string name;
  StageSet* stages = nullptr;
  bool on_gpu = false;
  bool slow = false;         ///< shaders in software: no whole search, no whole frame
  void (*wait)() = nullptr;  ///< until the device has done all; null: no call leaves work behind
};

/// Each stage of a path by the wall clock, with what it moves between host and device.
std::vector<Row> stageRows(const Workload& load, const BenchPath& path, int runs);

#ifdef RP_HAVE_CUDA
/// The kernels alone, by events of the device.
std::vector<Row> kernelRows(const Workload& load, int runs);
Ceilings measureCeilings();
void waitForDevice();
#endif

}  // namespace rangepose::device_bench
