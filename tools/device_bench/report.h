// Times of stages on each path as a Markdown table.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace rangepose::device_bench {

/// What a stage has to do, whatever runs it. 0: not counted.
struct Work {
  double bytes = 0.0;       ///< read and written at least once [B]
  double operations = 0.0;  ///< floating-point
};

struct Row {
  std::string what;
  std::string path;
  double median_ms = 0.0;
  double low_ms = 0.0;   ///< a tenth of the runs was faster
  double high_ms = 0.0;  ///< a tenth of the runs was slower
  int runs = 0;
  Work work;
  bool on_gpu = false;  ///< shares of the ceilings mean something
};

/// What the GPU does at best, measured here. 0: not measured.
struct Ceilings {
  double bytes_per_s = 0.0;       ///< a large copy on the device, read and written
  double operations_per_s = 0.0;  ///< multiply-adds in float, two operations each
};

/// Runs `once` twice untimed, then until there are `runs` or two seconds are over, three times at
/// least. `once` gives its own time [ms].
Row timed(const std::string& what,
          const std::string& path,
          int runs,
          const std::function<double()>& once);

/// `work` by the wall clock [ms].
double wallMs(const std::function<void()>& work);

std::string markdownTable(const std::vector<Row>& rows, const Ceilings& ceilings);

}  // namespace rangepose::device_bench
