#include "debug/stage_pictures.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <set>
#include <string>

#include "core/error.h"
#include "debug/canvas.h"
#include "debug/colour.h"
#include "debug/relief.h"

namespace rangepose::debug {
namespace {

constexpr int kSceneTargetPx = 960;
constexpr int kSidePx = 640;  // of pictures that share the page with another
const cv::Vec3b kEdgeColour(60, 220, 255);
const cv::Vec3b kBodyColour(150, 150, 150);
const cv::Vec3d kOchre(40, 140, 200);

int sceneZoom(int width, int height) { return enlargement(width, height, kSceneTargetPx); }

std::string share(std::size_t part, std::size_t all) {
  return number(all > 0 ? 100.0 * static_cast<double>(part) / static_cast<double>(all) : 0.0, 1) +
         " %";
}

}  // namespace

cv::Mat edgePixels(const Image<float>& range_px, const Image<float>& edges) {
  RP_CHECK(range_px.width() == edges.width() && range_px.height() == edges.height(),
           "range and edges differ in size");
  cv::Mat pixels(edges.height(), edges.width(), CV_8UC3);
  for (int y = 0; y < edges.height(); ++y) {
    for (int x = 0; x < edges.width(); ++x) {
      const cv::Vec3b body = range_px.at(x, y) != 0.0f ? kBodyColour : kMissingColour;
      pixels.at<cv::Vec3b>(y, x) = edges.at(x, y) != 0.0f ? kEdgeColour : body;
    }
  }
  return pixels;
}

cv::Mat depthPicture(const DepthImage& image) {
  const ColourScale scale = scaleOf(image.depth_mm, "depth", "mm");
  const int zoom = enlargement(image.depth_mm.width(), image.depth_mm.height(), kSidePx);
  const std::string note = sizeText(image.depth_mm.width(), image.depth_mm.height()) + ", " +
                           valueSummary(image.depth_mm, scale);
  return titled(beside({enlarged(relief(image), zoom), colourMap(image.depth_mm, scale, kSidePx)}),
                "Depth image: shaded (left) and in colours (right)",
                note);
}

cv::Mat keepMaskPicture(const DepthImage& image, const Image<std::uint8_t>& keep) {
  RP_CHECK(keep.empty() ||
               (keep.width() == image.depth_mm.width() && keep.height() == image.depth_mm.height()),
           "the background mask has another size than the depth image");
  cv::Mat pixels = relief(image);
  std::size_t measured = 0;
  std::size_t kept = 0;
  for (int y = 0; y < image.depth_mm.height(); ++y) {
    for (int x = 0; x < image.depth_mm.width(); ++x) {
      if (image.depth_mm.at(x, y) == 0.0f) continue;
      ++measured;
      if (keep.empty() || keep.at(x, y) != 0) {
        ++kept;
        continue;
      }
      cv::Vec3b& pixel = pixels.at<cv::Vec3b>(y, x);
      pixel = cv::Vec3b(0.4 * cv::Vec3d(pixel) + 0.6 * kOchre);
    }
  }
  return titled(enlarged(pixels, sceneZoom(pixels.cols, pixels.rows)),
                "Kept pixels grey, background ochre, holes violet",
                share(kept, measured) + " of the measured pixels are kept");
}

cv::Mat rangePicture(const Image<float>& range_px) {
  const ColourScale scale = scaleOf(range_px, "range", "px");
  return titled(
      colourMap(range_px, scale, kSceneTargetPx),
      "Orthographic range",
      sizeText(range_px.width(), range_px.height()) + ", " + valueSummary(range_px, scale));
}

cv::Mat edgePicture(const Image<float>& range_px, const Image<float>& edges) {
  const cv::Mat pixels = edgePixels(range_px, edges);
  const auto count = static_cast<std::size_t>(
      std::count_if(edges.begin(), edges.end(), [](float edge) { return edge != 0.0f; }));
  return titled(enlarged(pixels, sceneZoom(pixels.cols, pixels.rows)),
                "Edges yellow, surface light grey, no data dark grey",
                std::to_string(count) + " edge pixels");
}

cv::Mat distancePicture(const Image<float>& distance_px) {
  const ColourScale scale = signedScaleOf(distance_px, "signed distance", "px");
  return titled(colourMap(distance_px, scale, kSceneTargetPx),
                "Signed distance to the nearest edge",
                "red on surfaces, blue on background");
}

cv::Mat patchPicture(const Image<std::int32_t>& labels) {
  std::set<std::int32_t> patches;
  for (const std::int32_t label : labels) {
    if (label != kNoPatch) patches.insert(label);
  }
  const cv::Mat pixels = labelPixels(labels);
  return titled(enlarged(pixels, sceneZoom(pixels.cols, pixels.rows)),
                std::to_string(patches.size()) + " patches",
                "a colour a patch; edges and background dark grey");
}

cv::Mat seedPicture(const Image<float>& range_px, const std::vector<Seed>& seeds) {
  const int zoom = sceneZoom(range_px.width(), range_px.height());
  const ColourScale scale = scaleOf(range_px, "range", "px");
  cv::Mat picture = colourMap(range_px, scale, kSceneTargetPx);
  cv::Mat field = picture(cv::Rect(0, 0, range_px.width() * zoom, range_px.height() * zoom));
  std::string note;
  for (std::size_t i = 0; i < seeds.size(); ++i) {
    const Seed& seed = seeds[i];
    const cv::Point at(cvRound((seed.x_px + 0.5f) * static_cast<float>(zoom)),
                       cvRound((seed.y_px + 0.5f) * static_cast<float>(zoom)));
    const int radius = std::max(3, cvRound(std::abs(seed.distance_px) * static_cast<float>(zoom)));
    cv::circle(field, at, radius, cv::Scalar(0, 0, 0), 4, cv::LINE_AA);
    cv::circle(field, at, radius, cv::Scalar(255, 255, 255), 2, cv::LINE_AA);
    cv::drawMarker(field, at, cv::Scalar(60, 60, 255), cv::MARKER_CROSS, 13, 2);
    drawPlate(field,
              {at.x + radius + 2, at.y - kTextPx},
              std::to_string(i + 1),
              cv::Scalar(120, 240, 255),
              kTextPx + 1);
    if (i < 6) {
      note += (i > 0 ? "; " : "") + std::to_string(i + 1) + ": range " + number(seed.range_px, 1) +
              " px, patch " + std::to_string(seed.patch_px) + " px";
    }
  }
  return titled(picture, std::to_string(seeds.size()) + " starts", note);
}

}  // namespace rangepose::debug
