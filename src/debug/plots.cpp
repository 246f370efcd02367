#include "debug/plots.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <opencv2/imgproc.hpp>

#include "core/error.h"
#include "core/parallel.h"
#include "debug/canvas.h"
#include "debug/colour.h"

namespace rangepose::debug {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr int kPlotWidth = 820;
constexpr int kPlotHeight = 380;
constexpr int kLeft = 64;
constexpr int kTop = 12;
constexpr int kBottom = 42;
constexpr int kMapWidth = 720;  // two pixels a degree
constexpr int kMapHeight = kMapWidth / 2;
const double kSameCellCos = std::cos(6.0 * kPi / 180.0);

/// Maps values to pixels of a plot with axes.
struct Axes {
  double x_max = 1.0;
  double y_max = 1.0;
  cv::Point2d at(double x, double y) const {
    return {kLeft + x / x_max * kPlotWidth, kTop + (1.0 - y / y_max) * kPlotHeight};
  }
};

void drawAxes(cv::Mat& plot, const Axes& axes) {
  const std::vector<double> y_ticks = roundTicks(0.0, axes.y_max, 6);
  const int decimals = y_ticks.size() > 1 ? decimalsFor(y_ticks[1] - y_ticks[0]) : 1;
  for (const double y : y_ticks) {
    const int row = static_cast<int>(axes.at(0.0, y).y);
    cv::line(plot, {kLeft, row}, {kLeft + kPlotWidth, row}, kRule);
    const std::string text = number(y, decimals);
    drawText(plot, {kLeft - 8 - textSize(text).width, row - kTextPx / 2}, text, kInk, kTextPx - 1);
  }
  for (const double x : roundTicks(0.0, axes.x_max, 8)) {
    const int column = static_cast<int>(axes.at(x, 0.0).x);
    cv::line(plot, {column, kTop + kPlotHeight}, {column, kTop + kPlotHeight + 4}, kInk);
    const std::string text = number(x, 0);
    drawText(
        plot, {column - textSize(text).width / 2, kTop + kPlotHeight + 9}, text, kInk, kTextPx - 1);
  }
  cv::rectangle(plot, cv::Rect(kLeft, kTop, kPlotWidth + 1, kPlotHeight + 1), kFaintInk);
  drawText(plot,
           {kLeft + kPlotWidth - 190, kTop + kPlotHeight + 26},
           "views, best first",
           kFaintInk,
           kTextPx - 1);
}

struct Curve {
  int window = 0;
  int best_view = 0;
  int not_compared = 0;
  std::vector<float> errors;  ///< ascending
};

std::vector<Curve> curvesOf(const std::vector<Hypothesis>& hypotheses) {
  std::map<int, std::vector<const Hypothesis*>> by_window;
  for (const Hypothesis& hypothesis : hypotheses)
    by_window[hypothesis.window].push_back(&hypothesis);
  std::vector<Curve> curves;
  for (auto& [window, members] : by_window) {
    std::stable_sort(members.begin(), members.end(), [](const Hypothesis* a, const Hypothesis* b) {
      return a->error < b->error;
    });
    Curve curve{window, members.front()->view, 0, {}};
    for (const Hypothesis* member : members) {
      if (member->error < kWorstError) {
        curve.errors.push_back(member->error);
      } else {
        ++curve.not_compared;
      }
    }
    curves.push_back(std::move(curve));
  }
  return curves;
}

std::string curveText(const Curve& curve) {
  const std::string name = "start " + std::to_string(curve.window + 1) + ": ";
  const std::string rest =
      curve.not_compared > 0 ? ", " + std::to_string(curve.not_compared) + " not comparable" : "";
  if (curve.errors.empty()) return name + "no view can be compared";
  return name + "best " + number(curve.errors.front(), 3) + " (view " +
         std::to_string(curve.best_view) + "), median " +
         number(curve.errors[curve.errors.size() / 2], 3) + rest;
}

/// One direction of view with the lowest error of the views around it.
struct Cell {
  glm::dvec3 direction{0.0};
  float error = 0.0f;
};

glm::dvec3 directionOf(const ReferenceView& view) {
  return {view.rotation[0][2], view.rotation[1][2], view.rotation[2][2]};
}

/// Best first, so that each cell is centred on its best view.
std::vector<Cell> cellsOf(const ReferenceObject& object,
                          const std::vector<Hypothesis>& hypotheses) {
  std::vector<const Hypothesis*> sorted;
  for (const Hypothesis& hypothesis : hypotheses) {
    const bool known =
        hypothesis.view >= 0 && hypothesis.view < static_cast<int>(object.views.size());
    RP_CHECK(known,
             "hypothesis of view " + std::to_string(hypothesis.view) + ", which its object lacks");
    if (hypothesis.error < kWorstError) sorted.push_back(&hypothesis);
  }
  std::stable_sort(sorted.begin(), sorted.end(), [](const Hypothesis* a, const Hypothesis* b) {
    return a->error < b->error;
  });
  std::vector<Cell> cells;
  for (const Hypothesis* hypothesis : sorted) {
    const glm::dvec3 direction =
        directionOf(object.views[static_cast<std::size_t>(hypothesis->view)]);
    const bool covered = std::any_of(cells.begin(), cells.end(), [&](const Cell& cell) {
      return glm::dot(cell.direction, direction) > kSameCellCos;
    });
    if (!covered) cells.push_back({direction, hypothesis->error});
  }
  return cells;
}

cv::Point mapPoint(const glm::dvec3& direction) {
  const double azimuth = std::atan2(direction.y, direction.x);
  const double elevation = std::asin(std::clamp(direction.z, -1.0, 1.0));
  return {static_cast<int>((azimuth / kPi + 1.0) / 2.0 * (kMapWidth - 1)),
          static_cast<int>((0.5 - elevation / kPi) * (kMapHeight - 1))};
}

/// Each pixel of the map takes the error of the nearest cell.
Image<float> errorMap(const std::vector<Cell>& cells) {
  Image<float> map(kMapWidth, kMapHeight);
  parallelFor(kMapHeight, 8, [&](int begin, int end) {
    for (int y = begin; y < end; ++y) {
      const double elevation = (0.5 - (y + 0.5) / kMapHeight) * kPi;
      for (int x = 0; x < kMapWidth; ++x) {
        const double azimuth = ((x + 0.5) / kMapWidth * 2.0 - 1.0) * kPi;
        const glm::dvec3 direction(std::cos(elevation) * std::cos(azimuth),
                                   std::cos(elevation) * std::sin(azimuth),
                                   std::sin(elevation));
        const auto nearest =
            std::max_element(cells.begin(), cells.end(), [&](const Cell& a, const Cell& b) {
              return glm::dot(a.direction, direction) < glm::dot(b.direction, direction);
            });
        if (nearest != cells.end()) map.at(x, y) = nearest->error;
      }
    }
  });
  return map;
}

/// Degrees along the lower and left side of a map.
cv::Mat withDegrees(const cv::Mat& map) {
  cv::Mat page(map.rows + 2 * kBottom, map.cols + kLeft + 20, CV_8UC3, kPaper);
  map.copyTo(page(cv::Rect(kLeft, kTop, map.cols, map.rows)));
  for (int degrees = -180; degrees <= 180; degrees += 60) {
    const int x = kLeft + (degrees + 180) * (kMapWidth - 1) / 360;
    cv::line(page, {x, kTop + kMapHeight}, {x, kTop + kMapHeight + 4}, kInk);
    const std::string text = std::to_string(degrees);
    drawText(page, {x - textSize(text).width / 2, kTop + kMapHeight + 9}, text, kInk, kTextPx - 1);
  }
  for (int degrees = -90; degrees <= 90; degrees += 30) {
    const int y = kTop + (90 - degrees) * (kMapHeight - 1) / 180;
    cv::line(page, {kLeft - 4, y}, {kLeft, y}, kInk);
    const std::string text = std::to_string(degrees);
    drawText(page, {kLeft - 8 - textSize(text).width, y - kTextPx / 2}, text, kInk, kTextPx - 1);
  }
  drawText(page,
           {kLeft, kTop + kMapHeight + 28},
           "azimuth (across) and elevation (up) of the viewing direction [deg]",
           kFaintInk,
           kTextPx - 1);
  return page;
}

}  // namespace

cv::Mat sortedErrorPlot(const std::vector<Hypothesis>& hypotheses) {
  const std::vector<Curve> curves = curvesOf(hypotheses);
  Axes axes;
  axes.y_max = 0.0;
  for (const Curve& curve : curves) {
    axes.x_max = std::max(axes.x_max, static_cast<double>(curve.errors.size()));
    if (curve.errors.empty()) continue;
    const auto high = static_cast<std::size_t>(0.98 * static_cast<double>(curve.errors.size() - 1));
    axes.y_max = std::max(axes.y_max, 1.05 * static_cast<double>(curve.errors[high]));
  }
  if (axes.y_max <= 0.0) axes.y_max = 1.0;
  cv::Mat plot(kTop + kPlotHeight + kBottom, kLeft + kPlotWidth + 24, CV_8UC3, kPaper);
  drawAxes(plot, axes);
  std::vector<cv::Mat> rows = {plot};
  for (const Curve& curve : curves) {
    const cv::Scalar colour(labelColour(curve.window * 7 + 2) * 0.8);
    for (std::size_t rank = 0; rank < curve.errors.size(); ++rank) {
      const double shown = std::min(static_cast<double>(curve.errors[rank]), axes.y_max);
      const cv::Point2d at = axes.at(static_cast<double>(rank) + 0.5, shown);
      cv::circle(plot, cv::Point(at), rank == 0 ? 5 : 2, colour, -1, cv::LINE_AA);
    }
    const std::string text = curveText(curve);
    cv::Mat entry(18, kLeft + 24 + textSize(text).width, CV_8UC3, kPaper);
    cv::circle(entry, {kLeft + 8, 8}, 5, colour, -1, cv::LINE_AA);
    drawText(entry, {kLeft + 22, 2}, text);
    rows.push_back(entry);
  }
  return below(rows, 4);
}

cv::Mat errorOverDirections(const ReferenceObject& object,
                            const std::vector<Hypothesis>& hypotheses) {
  const std::vector<Cell> cells = cellsOf(object, hypotheses);
  const Image<float> values = errorMap(cells);
  const ColourScale scale = scaleOf(values, "lowest error", "");
  cv::Mat map = colourPixels(values, scale);
  for (const Cell& cell : cells) {
    cv::circle(map, mapPoint(cell.direction), 1, cv::Scalar(255, 255, 255), -1);
  }
  if (!cells.empty()) {
    cv::circle(map, mapPoint(cells.front().direction), 8, cv::Scalar(0, 0, 0), 4, cv::LINE_AA);
    cv::circle(map, mapPoint(cells.front().direction), 8, cv::Scalar(60, 60, 255), 2, cv::LINE_AA);
  }
  return beside({withDegrees(map), colourBar(scale, kMapHeight)});
}

}  // namespace rangepose::debug
