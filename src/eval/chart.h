// Line charts of the evaluation, as pictures.
#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

namespace rangepose {

struct ChartCurve {
  std::string name;  ///< in the legend
  std::vector<cv::Point2d>
      points;         ///< in the units of the axes; ones that are not finite are left out
  bool dots = false;  ///< marks the points
};

struct ChartAxis {
  std::string label;
  double low = 0.0;
  double high = 1.0;
};

struct Chart {
  std::string title;
  std::string note;  ///< fainter, below the title
  ChartAxis x;
  ChartAxis y;
  std::vector<ChartCurve> curves;
  bool diagonal = false;  ///< a faint line from corner to corner: where both axes agree
};

/// Throws Error for an axis without extent.
cv::Mat drawChart(const Chart& chart);

}  // namespace rangepose
