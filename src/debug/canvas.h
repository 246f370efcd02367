// Small drawing kit of the debug pictures: text, panels side by side, PNG files.
#pragma once

#include <filesystem>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

namespace rangepose::debug {

// Colours of the page, in OpenCV's order (blue, green, red).
inline const cv::Scalar kPaper{255, 255, 255};
inline const cv::Scalar kInk{45, 40, 40};
inline const cv::Scalar kFaintInk{120, 115, 115};
inline const cv::Scalar kRule{200, 200, 200};

inline constexpr int kTextPx = 12;  ///< height of a capital letter in running text [px]
inline constexpr int kGapPx = 12;   ///< between panels [px]

/// Width and height of a line of text whose capitals are `capital_px` high [px].
cv::Size textSize(const std::string& text, int capital_px = kTextPx);

/// Anti-aliased text; `top_left` is the corner of its capitals.
void drawText(cv::Mat& canvas,
              cv::Point top_left,
              const std::string& text,
              const cv::Scalar& colour = kInk,
              int capital_px = kTextPx);

/// The plate of drawPlate, moved so that it stays on a canvas of the given size.
cv::Rect plateOf(cv::Size canvas,
                 cv::Point top_left,
                 const std::string& text,
                 int capital_px = kTextPx);

/// Text on a dark plate, for pictures of any brightness.
void drawPlate(cv::Mat& canvas,
               cv::Point top_left,
               const std::string& text,
               const cv::Scalar& colour,
               int capital_px = kTextPx);

/// Panels from left to right on white, tops aligned; empty ones are left out.
cv::Mat beside(const std::vector<cv::Mat>& panels, int gap_px = kGapPx);

/// Panels from top to bottom on white, left sides aligned; empty ones are left out.
cv::Mat below(const std::vector<cv::Mat>& panels, int gap_px = kGapPx);

/// A title, and a fainter note under it, above a panel.
cv::Mat titled(const cv::Mat& panel, const std::string& title, const std::string& note = "");

/// White space around a page.
cv::Mat framed(const cv::Mat& panel, int margin_px = kGapPx);

/// Every pixel becomes a square of `factor` pixels.
cv::Mat enlarged(const cv::Mat& pixels, int factor);

/// The largest whole factor that keeps both sides within `target_px`, at least 1.
int enlargement(int width, int height, int target_px);

/// `value` with the given number of decimals.
std::string number(double value, int decimals);

/// Decimals that tell values `step` apart.
int decimalsFor(double step);

/// Round values (1, 2 or 5 times a power of ten apart) inside [low, high], about `count` of them.
std::vector<double> roundTicks(double low, double high, int count);

/// A size as "W x H px".
std::string sizeText(int width, int height);

/// Writes a PNG file whole or not at all; throws Error naming the file when it cannot be written.
void writePng(const std::filesystem::path& file, const cv::Mat& picture);

}  // namespace rangepose::debug
