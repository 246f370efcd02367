#include "debug/statistics_pictures.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>

#include "core/error.h"
#include "core/parallel.h"
#include "debug/canvas.h"
#include "debug/colour.h"

namespace rangepose::debug {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kDegree = kPi / 180.0;
constexpr int kBins = 36;
constexpr int kBarPx = 9;
constexpr int kHistogramHeight = 160;
constexpr int kAxisHeight = 24;
constexpr int kMapDegreesPerCell = 3;
constexpr int kMapCellPx = 8;
constexpr double kCapDegrees = 5.0;

/// Shares of the values in even bins over [low, high].
std::vector<double> shares(const std::vector<double>& values, double low, double high, int bins) {
  std::vector<double> result(static_cast<std::size_t>(bins), 0.0);
  for (const double value : values) {
    const int bin = static_cast<int>((value - low) / (high - low) * bins);
    result[static_cast<std::size_t>(std::clamp(bin, 0, bins - 1))] += 1.0;
  }
  for (double& share : result) share /= static_cast<double>(values.size());
  return result;
}

cv::Mat histogram(const std::vector<double>& degrees,
                  double low,
                  double high,
                  int bins,
                  const std::string& title) {
  const std::vector<double> bars = shares(degrees, low, high, bins);
  const double tallest = *std::max_element(bars.begin(), bars.end());
  const int width = bins * kBarPx;
  cv::Mat panel(kHistogramHeight + kAxisHeight, width + 1, CV_8UC3, kPaper);
  for (int i = 0; i < bins; ++i) {
    const double share = bars[static_cast<std::size_t>(i)];
    const int height = static_cast<int>(std::round(share / tallest * (kHistogramHeight - 8)));
    if (height > 0) {
      const cv::Rect bar(i * kBarPx + 1, kHistogramHeight - height, kBarPx - 1, height);
      cv::rectangle(panel, bar, cv::Scalar(160, 110, 60), cv::FILLED);
    }
  }
  cv::line(panel, {0, kHistogramHeight}, {width, kHistogramHeight}, kInk);
  for (int tick = 0; tick <= 4; ++tick) {
    const std::string text = number(low + (high - low) * tick / 4.0, 0);
    const int x =
        std::clamp(width * tick / 4 - textSize(text).width / 2, 0, width - textSize(text).width);
    drawText(panel, {x, kHistogramHeight + 8}, text, kInk, kTextPx - 1);
  }
  return titled(panel, title, "tallest bar: " + number(100.0 * tallest, 1) + " % of all");
}

glm::dvec3 viewDirection(const glm::dmat3& r) { return {r[0][2], r[1][2], r[2][2]}; }

double azimuth(const glm::dvec3& d) { return std::atan2(d.y, d.x) / kDegree; }
double elevation(const glm::dvec3& d) { return std::asin(std::clamp(d.z, -1.0, 1.0)) / kDegree; }

/// Angle of the image's x axis against the horizontal of the object that azimuth and elevation
/// define [degrees].
double inPlane(const glm::dmat3& r) {
  const glm::dvec3 d = viewDirection(r);
  const double a = azimuth(d) * kDegree;
  const glm::dvec3 right(-std::sin(a), std::cos(a), 0.0);
  const glm::dvec3 seen = r * right;
  return std::atan2(seen.y, seen.x) / kDegree;
}

/// Observations within a cap about each cell over what an even spread would give there; row 0 is
/// elevation +90. Caps are equally large everywhere, cells are not.
Image<float> densityMap(const std::vector<glm::dmat3>& rotations) {
  const double cap = std::cos(kCapDegrees * kDegree);
  const double even = 0.5 * (1.0 - cap) * static_cast<double>(rotations.size());
  std::vector<glm::dvec3> directions;
  directions.reserve(rotations.size());
  for (const glm::dmat3& rotation : rotations) directions.push_back(viewDirection(rotation));
  Image<float> map(360 / kMapDegreesPerCell, 180 / kMapDegreesPerCell, 0.0f);
  parallelFor(map.height(), 1, [&](int row, int) {
    const double up = (90.0 - kMapDegreesPerCell * (row + 0.5)) * kDegree;
    for (int column = 0; column < map.width(); ++column) {
      const double around = (kMapDegreesPerCell * (column + 0.5) - 180.0) * kDegree;
      const glm::dvec3 centre(
          std::cos(up) * std::cos(around), std::cos(up) * std::sin(around), std::sin(up));
      const auto inside =
          std::count_if(directions.begin(), directions.end(), [&](const glm::dvec3& direction) {
            return glm::dot(direction, centre) >= cap;
          });
      map.at(column, row) = static_cast<float>(static_cast<double>(inside) / even);
    }
  });
  return map;
}

}  // namespace

glm::dvec3 eulerAngles(const glm::dmat3& rotation) {
  const double sine = std::clamp(-rotation[0][2], -1.0, 1.0);
  const double y = std::asin(sine);
  if (std::abs(sine) > 1.0 - 1e-12) {
    return {0.0, y, std::atan2(-rotation[1][0], rotation[1][1])};  // only x -+ z is defined
  }
  return {
      std::atan2(rotation[1][2], rotation[2][2]), y, std::atan2(rotation[0][1], rotation[0][0])};
}

cv::Mat eulerHistograms(const std::vector<glm::dmat3>& camera_from_object) {
  RP_CHECK(!camera_from_object.empty(), "histograms: no orientations");
  std::vector<double> x;
  std::vector<double> y;
  std::vector<double> z;
  for (const glm::dmat3& rotation : camera_from_object) {
    const glm::dvec3 angles = eulerAngles(rotation) / kDegree;
    x.push_back(angles.x);
    y.push_back(angles.y);
    z.push_back(angles.z);
  }
  return beside({histogram(x, -180.0, 180.0, kBins, "about x [degrees]"),
                 histogram(y, -90.0, 90.0, kBins, "about y [degrees]"),
                 histogram(z, -180.0, 180.0, kBins, "about z [degrees]")},
                2 * kGapPx);
}

cv::Mat sphericalPicture(const std::vector<glm::dmat3>& camera_from_object,
                         const std::vector<glm::dmat3>& views) {
  RP_CHECK(!camera_from_object.empty(), "spherical picture: no orientations");
  const Image<float> density = densityMap(camera_from_object);
  ColourScale scale = scaleOf(density, "density", "of an even spread", false);
  scale.min = 0.0f;
  scale.max = std::max(scale.max, 1.0f);
  cv::Mat map = enlarged(colourPixels(density, scale), kMapCellPx);
  const double px = static_cast<double>(kMapCellPx) / kMapDegreesPerCell;
  for (const glm::dmat3& view : views) {
    const glm::dvec3 d = viewDirection(view);
    const cv::Point at(static_cast<int>((azimuth(d) + 180.0) * px),
                       static_cast<int>((90.0 - elevation(d)) * px));
    cv::circle(map, at, 2, cv::Scalar(255, 255, 255), cv::FILLED, cv::LINE_AA);
  }
  std::vector<double> angles;
  angles.reserve(camera_from_object.size());
  for (const glm::dmat3& rotation : camera_from_object) angles.push_back(inPlane(rotation));
  const std::string note =
      views.empty() ? "azimuth -180..180 to the right, elevation -90..90 upwards"
                    : "azimuth -180..180 to the right, elevation -90..90 upwards; dots: directions "
                      "of the views";
  const cv::Mat sphere =
      titled(beside({map, colourBar(scale, map.rows)}), "viewing directions", note);
  return below({sphere, histogram(angles, -180.0, 180.0, 2 * kBins, "in-plane angle [degrees]")});
}

cv::Mat statisticsPage(const std::string& title,
                       const std::string& note,
                       const std::vector<glm::dmat3>& camera_from_object,
                       const std::vector<glm::dmat3>& views) {
  const cv::Mat page =
      below({eulerHistograms(camera_from_object), sphericalPicture(camera_from_object, views)},
            2 * kGapPx);
  return framed(titled(page, title, note));
}

}  // namespace rangepose::debug
