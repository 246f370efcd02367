// Bars made of parts, for times by stage.
#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

namespace rangepose {

struct StackedBars {
  std::string title;
  std::string note;                ///< fainter, below the title
  std::string unit;                ///< of the parts
  std::vector<std::string> parts;  ///< names, in the order in which they lie in a bar
  struct Bar {
    std::string name;
    std::vector<double> values;  ///< one for each part, not negative [unit]
  };
  std::vector<Bar> bars;
};

/// Throws Error when a bar does not have a value for each part.
cv::Mat drawStackedBars(const StackedBars& chart);

}  // namespace rangepose
