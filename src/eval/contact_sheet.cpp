#include "eval/contact_sheet.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "debug/canvas.h"
#include "debug/colour.h"
#include "debug/relief.h"
#include "eval/vsd.h"

namespace rangepose {
namespace {

constexpr int kPicturePx = 190;  ///< height of a picture
const cv::Vec3b kRight{60, 180, 60};
const cv::Vec3b kWrong{40, 40, 220};

/// Colours the pixels of a posed model that the image shows or could show; the outline fully.
void mark(const Mesh& mesh,
          const Pose& pose,
          const cv::Vec3b& colour,
          const BinScan& scan,
          cv::Mat& picture) {
  const PosedModel model = renderPosed(mesh, scan.image.camera, pose);
  const auto covered = [&model](int x, int y) {
    return model.distance_mm.contains(x, y) && model.distance_mm.at(x, y) > 0.0f;
  };
  for (int y = 0; y < model.distance_mm.height(); ++y) {
    for (int x = 0; x < model.distance_mm.width(); ++x) {
      if (!covered(x, y)) continue;
      const bool inside =
          covered(x - 2, y) && covered(x + 2, y) && covered(x, y - 2) && covered(x, y + 2);
      cv::Vec3b& pixel = picture.at<cv::Vec3b>(model.box.y0 + y, model.box.x0 + x);
      pixel = inside ? cv::Vec3b(0.5 * pixel + 0.5 * colour) : colour;
    }
  }
}

cv::Mat scaled(const cv::Mat& picture) {
  const double factor = static_cast<double>(kPicturePx) / picture.rows;
  cv::Mat result;
  cv::resize(picture, result, {}, factor, factor, cv::INTER_AREA);
  return result;
}

}  // namespace

ContactSheet::ContactSheet(const Mesh& mesh, std::string title, int columns)
    : mesh_(&mesh), title_(std::move(title)), columns_(columns) {
  RP_CHECK(columns >= 1, "contact sheet: at least one column is needed");
}

void ContactSheet::add(const Trial& trial, const BinScan& scan, const TrialAnswer& answer) {
  cv::Mat bin = debug::relief(scan.image);
  if (answer.fine) mark(*mesh_, *answer.fine, trial.fine.right ? kRight : kWrong, scan, bin);
  const cv::Mat depth =
      debug::colourPixels(scan.image.depth_mm, debug::scaleOf(scan.image.depth_mm, "depth", "mm"));
  std::string caption = fmt::format("{} ", trial.number + 1);
  caption += !answer.fine ? std::string("no pose")
                          : fmt::format("{}, {:.2f} % off, score {:.2f}",
                                        trial.fine.right ? "right" : "wrong",
                                        100.0 * trial.fine.vertex,
                                        answer.score);
  tiles_.push_back(debug::titled(debug::beside({scaled(bin), scaled(depth)}, 2), caption));
}

cv::Mat ContactSheet::picture() const {
  std::vector<cv::Mat> rows;
  const auto width = static_cast<std::size_t>(columns_);
  for (std::size_t first = 0; first < tiles_.size(); first += width) {
    const std::size_t last = std::min(tiles_.size(), first + width);
    rows.push_back(debug::beside({tiles_.begin() + static_cast<std::ptrdiff_t>(first),
                                  tiles_.begin() + static_cast<std::ptrdiff_t>(last)}));
  }
  return debug::framed(
      debug::titled(debug::below(rows),
                    title_,
                    "Left what lies in the bin and the part that was detected (green: "
                    "right), right the scan; the part is then taken out."));
}

}  // namespace rangepose
