#include "debug/overlay.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <opencv2/imgproc.hpp>

#include "core/error.h"
#include "debug/canvas.h"
#include "debug/model_layer.h"
#include "debug/overlay_legend.h"
#include "debug/relief.h"

namespace rangepose::debug {
namespace {

constexpr int kPanelMinPx = 640;  // wide enough for two panels to fill 1200 px
constexpr int kPanelMaxPx = 1000;
constexpr int kFirstZoomPx = 620;  // wished for side of the first enlarged view
constexpr int kZoomPx = 410;       // of the others: two of them share a row
constexpr int kZoomMaxPx = 1600;   // limits the memory when a part fills a large image
constexpr double kZoomMin = 3.0;
constexpr int kMinWidth = 1200;

double toleranceOf(const std::vector<OverlayPose>& poses, const OverlayOptions& options) {
  if (options.tolerance_mm > 0.0) return options.tolerance_mm;
  double smallest = 0.0;
  for (const OverlayPose& pose : poses) {
    const double size = diameter(*pose.mesh);
    if (smallest == 0.0 || size < smallest) smallest = size;
  }
  return smallest > 0.0 ? kToleranceShare * smallest : 1.0;
}

std::string labelText(const OverlayPose& pose) {
  return (pose.label.empty() ? "" : pose.label + "  ") + number(pose.score, 3);
}

/// Above the object, or where the labels placed before leave room.
void drawLabel(cv::Mat& picture,
               const std::string& text,
               const PixelBox& box,
               const PictureView& view,
               std::vector<cv::Rect>& taken) {
  if (box.empty()) return;
  const cv::Point2d low = view.pictureFrom(box.x0, box.y0);
  const cv::Point2d high = view.pictureFrom(box.x1, box.y1);
  constexpr int kStep = kTextPx + 10;
  const int x = static_cast<int>(low.x);
  cv::Rect plate;
  for (int attempt = 0; attempt < 8; ++attempt) {
    const int away = attempt / 2 * kStep;
    const double y = attempt % 2 == 0 ? low.y - kStep - 6 - away : high.y + 8 + away;
    plate = plateOf(picture.size(), {x, static_cast<int>(y)}, text);
    const bool free = std::none_of(taken.begin(), taken.end(), [&](const cv::Rect& other) {
      return !(plate & other).empty();
    });
    if (free) break;
  }
  taken.push_back(plate);
  drawPlate(picture, plate.tl(), text, cv::Scalar(120, 240, 255));
}

/// The measured part of the image and all models, with a margin: bins are often cut out of a wide
/// image.
PixelBox worthShowing(const DepthImage& image, const std::vector<PixelBox>& boxes) {
  PixelBox used{image.depth_mm.width(), image.depth_mm.height(), 0, 0};
  const auto include = [&](const PixelBox& box) {
    used = {std::min(used.x0, box.x0),
            std::min(used.y0, box.y0),
            std::max(used.x1, box.x1),
            std::max(used.y1, box.y1)};
  };
  for (int y = 0; y < image.depth_mm.height(); ++y) {
    for (int x = 0; x < image.depth_mm.width(); ++x) {
      if (image.depth_mm.at(x, y) != 0.0f) include({x, y, x + 1, y + 1});
    }
  }
  for (const PixelBox& box : boxes) {
    if (!box.empty()) include(box);
  }
  const PixelBox all{0, 0, image.depth_mm.width(), image.depth_mm.height()};
  if (used.empty()) return all;
  const int margin = all.width() / 40 + 2;
  return {std::max(0, used.x0 - margin),
          std::max(0, used.y0 - margin),
          std::min(all.x1, used.x1 + margin),
          std::min(all.y1, used.y1 + margin)};
}

PixelBox zoomBox(const PixelBox& box, const Camera& camera) {
  const int margin = 6 + std::max(box.width(), box.height()) / 4;
  return {std::max(0, box.x0 - margin),
          std::max(0, box.y0 - margin),
          std::min(camera.width, box.x1 + margin),
          std::min(camera.height, box.y1 + margin)};
}

PictureView zoomView(const PixelBox& source, int wished_px) {
  const double side = std::max(source.width(), source.height());
  const double scale = std::max(kZoomMin, wished_px / side);
  return pictureView(source, std::min(scale, kZoomMaxPx / side));
}

std::string percent(int part, int all) {
  return number(all > 0 ? 100.0 * part / all : 0.0, 0) + " %";
}

std::string agreementText(const Agreement& a) {
  return "of " + std::to_string(a.model_px) +
         " px of the model: " + percent(a.agrees_px, a.model_px) + " agree, " +
         percent(a.in_front_px, a.model_px) + " in front of the data, " +
         percent(a.hidden_px, a.model_px) + " hidden, " + percent(a.missing_px, a.model_px) +
         " without data";
}

}  // namespace

Agreement agreementOf(const DepthImage& image, const OverlayPose& pose, double tolerance_mm) {
  const ModelLayer layer = renderModels({pose}, image.camera);
  Agreement result;
  for (int y = 0; y < image.depth_mm.height(); ++y) {
    for (int x = 0; x < image.depth_mm.width(); ++x) {
      if (layer.owner.at(x, y) < 0) continue;
      ++result.model_px;
      const float scene_mm = image.depth_mm.at(x, y);
      const double difference = scene_mm - layer.surface.at(x, y).w;
      if (scene_mm == 0.0f) {
        ++result.missing_px;
      } else if (std::abs(difference) <= tolerance_mm) {
        ++result.agrees_px;
      } else {
        ++(difference > 0.0 ? result.in_front_px : result.hidden_px);
      }
    }
  }
  return result;
}

namespace {

OverlayPanel moved(OverlayPanel panel, cv::Point by) {
  panel.box.x += by.x;
  panel.box.y += by.y;
  return panel;
}

/// Puts the picture together, from top to bottom.
class OverlayPage {
 public:
  OverlayPage(const DepthImage& image,
              const std::vector<OverlayPose>& poses,
              const OverlayOptions& options)
      : image_(image), poses_(poses), relief_(relief(image)) {
    result_.tolerance_mm = toleranceOf(poses, options);
    for (const OverlayPose& pose : poses) {
      boxes_.push_back(projectedBox(pose, image.camera));
      result_.agreement.push_back(agreementOf(image, pose, result_.tolerance_mm));
    }
    addWholeView();
    for (std::size_t i = 0; i < poses.size() && static_cast<int>(i) < options.max_zooms; ++i)
      addZoom(i);
    place(overlayLegend(result_.tolerance_mm), true);
  }

  OverlayPicture finished() {
    cv::Mat page = below(rows_);
    if (page.cols < kMinWidth) {
      cv::copyMakeBorder(page, page, 0, 0, 0, kMinWidth - page.cols, cv::BORDER_CONSTANT, kPaper);
    }
    result_.image = framed(page);
    return result_;
  }

 private:
  struct Block {
    cv::Mat picture;
    OverlayPanel relief;   ///< relative to the block
    OverlayPanel overlay;  ///< relative to the block
  };

  /// Both sides of a view under a title, with some of the poses: a model that covers another one
  /// would hide what speaks for it.
  Block block(const PictureView& view,
              const std::string& title,
              const std::string& note,
              const std::vector<std::size_t>& which) {
    std::vector<OverlayPose> painted;
    painted.reserve(which.size());
    for (const std::size_t i : which) painted.push_back(poses_[i]);
    cv::Mat overlay = paintModels(image_, relief_, painted, view, result_.tolerance_mm);
    std::vector<cv::Rect> taken;
    for (const OverlayPose& pose : painted) drawAxes(overlay, pose, view.camera(image_.camera));
    for (const std::size_t i : which)
      drawLabel(overlay, labelText(poses_[i]), boxes_[i], view, taken);
    const cv::Mat pair = beside({shown(relief_, view), overlay});
    Block result{titled(pair, title, note), {}, {}};
    const int top = result.picture.rows - pair.rows;
    result.relief = {{0, top, view.width, view.height}, view.source, view.scale};
    result.overlay = result.relief;
    result.overlay.box.x += view.width + kGapPx;
    return result;
  }

  /// Puts a picture to the right of the last one where there is room, else below; returns its
  /// corner.
  cv::Point place(const cv::Mat& picture, bool own_row = false) {
    const int page = rows_.empty() ? 0 : std::max(rows_.front().cols, kMinWidth);
    if (!own_row && rows_.size() > 1 && rows_.back().cols + 2 * kGapPx + picture.cols <= page) {
      const cv::Point corner(kGapPx + rows_.back().cols + 2 * kGapPx, y_);
      rows_.back() = beside({rows_.back(), picture}, 2 * kGapPx);
      return corner;
    }
    if (!rows_.empty()) y_ += rows_.back().rows + kGapPx;
    rows_.push_back(picture);
    return {kGapPx, y_};
  }

  void addWholeView() {
    const PixelBox source = worthShowing(image_, boxes_);
    double scale = std::max(1.0, std::ceil(static_cast<double>(kPanelMinPx) / source.width()));
    scale = std::min(scale,
                     static_cast<double>(kPanelMaxPx) / std::max(source.width(), source.height()));
    std::vector<std::size_t> all(poses_.size());
    std::iota(all.begin(), all.end(), std::size_t{0});
    const std::string cut =
        source.width() < image_.camera.width || source.height() < image_.camera.height
            ? ", only the measured part"
            : "";
    const Block views = block(
        pictureView(source, scale),
        "Depth image (left) and " + std::to_string(poses_.size()) + " pose(s) over it (right)",
        sizeText(image_.camera.width, image_.camera.height) + cut + ", shown " + number(scale, 2) +
            " times",
        all);
    const cv::Point corner = place(views.picture);
    result_.relief = moved(views.relief, corner);
    result_.overlay = moved(views.overlay, corner);
  }

  void addZoom(std::size_t i) {
    if (boxes_[i].empty()) {
      result_.zooms.emplace_back();
      place(titled({}, labelText(poses_[i]) + ": outside of the image"));
      return;
    }
    const PictureView view =
        zoomView(zoomBox(boxes_[i], image_.camera), i == 0 ? kFirstZoomPx : kZoomPx);
    const std::string title =
        labelText(poses_[i]) + ", " + number(view.scale, 1) + " times enlarged";
    const Block views = block(view, title, agreementText(result_.agreement[i]), {i});
    result_.zooms.push_back(moved(views.overlay, place(views.picture)));
  }

  const DepthImage& image_;
  const std::vector<OverlayPose>& poses_;
  cv::Mat relief_;
  std::vector<PixelBox> boxes_;
  std::vector<cv::Mat> rows_;
  int y_ = kGapPx;
  OverlayPicture result_;
};

}  // namespace

OverlayPicture drawOverlay(const DepthImage& image,
                           const std::vector<OverlayPose>& poses,
                           const OverlayOptions& options) {
  RP_CHECK(image.camera.width == image.depth_mm.width() &&
               image.camera.height == image.depth_mm.height() && !image.depth_mm.empty(),
           "the overlay needs a depth image of its camera's size");
  for (const OverlayPose& pose : poses)
    RP_CHECK(pose.mesh != nullptr, "an overlay pose has no mesh");
  return OverlayPage(image, poses, options).finished();
}

void writeOverlay(const std::filesystem::path& file,
                  const DepthImage& image,
                  const std::vector<OverlayPose>& poses,
                  const OverlayOptions& options) {
  writePng(file, drawOverlay(image, poses, options).image);
}

}  // namespace rangepose::debug
