// The pictures of the search: windows, best views, atlas.
#include <algorithm>
#include <cmath>
#include <functional>
#include <opencv2/imgproc.hpp>
#include <string>

#include "core/error.h"
#include "debug/canvas.h"
#include "debug/colour.h"
#include "debug/stage_pictures.h"

namespace rangepose::debug {
namespace {

constexpr int kWindowPx = 384;      // wished for width of a window's panel
constexpr int kAtlasPanelPx = 640;  // wished for width of an atlas panel
constexpr float kDifferencePx = 8.0f;
constexpr float kNone = 0.0f;
const cv::Scalar kSquare(255, 255, 255);
const cv::Scalar kOutline(40, 225, 255);

/// The place of a reference image in the middle of a window, and the window's centre.
cv::Mat withReferenceSquare(cv::Mat panel, int zoom) {
  const int side = panel.cols / kWindowScale;
  const cv::Rect square((panel.cols - side) / 2, (panel.rows - side) / 2, side, side);
  cv::rectangle(panel, square, cv::Scalar(0, 0, 0), 3);
  cv::rectangle(panel, square, kSquare, 1);
  const cv::Point centre(panel.cols / 2 + zoom / 2, panel.rows / 2 + zoom / 2);
  cv::drawMarker(panel, centre, cv::Scalar(60, 60, 255), cv::MARKER_CROSS, 15, 2);
  return panel;
}

void checkAtlas(const ReferenceObject& object) {
  RP_CHECK(object.columns() > 0, "object " + std::to_string(object.id) + " has no views");
}

/// The atlas channel of a view.
float channelOf(const ReferenceObject& object, int view, int u, int v, int channel) {
  const glm::ivec2 origin = object.tileOrigin(view);
  return object.atlas.at(origin.x + u, origin.y + v)[channel];
}

/// The range that a view predicts, laid into a window (see Hypothesis).
Image<float> predictedRange(const ReferenceObject& object,
                            const SceneChannels& window,
                            const Hypothesis& hypothesis) {
  Image<float> predicted(window.range_px.width(), window.range_px.height(), kNone);
  const int margin = (window.range_px.width() - object.size) / 2;
  const int dx = margin + static_cast<int>(std::floor(hypothesis.translation_px.x + 0.5f));
  const int dy = margin + static_cast<int>(std::floor(hypothesis.translation_px.y + 0.5f));
  for (int v = 0; v < object.size; ++v) {
    for (int u = 0; u < object.size; ++u) {
      const float range = channelOf(object, hypothesis.view, u, v, 1);
      if (range == 0.0f || !predicted.contains(u + dx, v + dy)) continue;
      predicted.at(u + dx, v + dy) =
          range - static_cast<float>(object.size) + hypothesis.translation_px.z;
    }
  }
  return predicted;
}

Image<float> difference(const Image<float>& scene, const Image<float>& predicted) {
  Image<float> result(scene.width(), scene.height(), std::nanf(""));
  for (int y = 0; y < scene.height(); ++y) {
    for (int x = 0; x < scene.width(); ++x) {
      if (scene.at(x, y) == 0.0f || predicted.at(x, y) == kNone) continue;
      result.at(x, y) = scene.at(x, y) - predicted.at(x, y);
    }
  }
  return result;
}

/// The border of the predicted pixels, drawn along the borders of the enlarged pixels.
void drawOutline(cv::Mat& panel, const Image<float>& predicted, int zoom) {
  const auto covered = [&](int x, int y) {
    return predicted.contains(x, y) && predicted.at(x, y) != kNone;
  };
  for (int y = 0; y <= predicted.height(); ++y) {
    for (int x = 0; x <= predicted.width(); ++x) {
      const cv::Point corner(x * zoom, y * zoom);
      if (covered(x, y) != covered(x - 1, y))
        cv::line(panel, corner, corner + cv::Point(0, zoom), kOutline, 2);
      if (covered(x, y) != covered(x, y - 1))
        cv::line(panel, corner, corner + cv::Point(zoom, 0), kOutline, 2);
    }
  }
}

cv::Mat bestViewRow(const ReferenceObject& object,
                    const SceneChannels& window,
                    const Hypothesis& best) {
  const int zoom = enlargement(window.range_px.width(), window.range_px.height(), kWindowPx);
  const Image<float> predicted = predictedRange(object, window, best);
  const ColourScale scale = scaleOf(window.range_px, "range", "px");
  cv::Mat scene = enlarged(colourPixels(window.range_px, scale), zoom);
  drawOutline(scene, predicted, zoom);
  const cv::Mat model = enlarged(colourPixels(predicted, scale), zoom);
  const ColourScale signed_scale{"scene - view", "px", -kDifferencePx, kDifferencePx, false, true};
  const cv::Mat gap = colourMap(difference(window.range_px, predicted), signed_scale, kWindowPx);
  const glm::vec3& t = best.translation_px;
  return titled(beside({scene, model, colourBar(scale, scene.rows), gap}),
                "Start " + std::to_string(best.window + 1) + ": best view " +
                    std::to_string(best.view) + ", error " + number(best.error, 3),
                "translation " + number(t.x, 2) + ", " + number(t.y, 2) + ", " + number(t.z, 2) +
                    " px after " + std::to_string(best.iterations) + " iterations");
}

/// One channel of some views in a square of tiles, with lines between them.
cv::Mat atlasPanel(const ReferenceObject& object,
                   int first,
                   int count,
                   const std::string& title,
                   ColourScale scale,
                   int channel) {
  const int columns = atlasColumns(count);
  const int rows = (count + columns - 1) / columns;
  Image<float> values(columns * object.size, rows * object.size, std::nanf(""));
  for (int i = 0; i < count; ++i) {
    for (int v = 0; v < object.size; ++v) {
      for (int u = 0; u < object.size; ++u) {
        values.at(i % columns * object.size + u, i / columns * object.size + v) =
            channelOf(object, first + i, u, v, channel);
      }
    }
  }
  if (scale.max == scale.min) {
    const ColourScale fitted = scale.signed_field ? signedScaleOf(values, scale.name, scale.unit)
                                                  : scaleOf(values, scale.name, scale.unit);
    scale.min = fitted.min;
    scale.max = fitted.max;
  }
  cv::Mat panel = colourMap(values, scale, kAtlasPanelPx);
  const int tile = object.size * enlargement(values.width(), values.height(), kAtlasPanelPx);
  for (int i = 1; i < columns; ++i)
    cv::line(panel, {i * tile, 0}, {i * tile, rows * tile - 1}, kInk);
  for (int i = 1; i < rows; ++i)
    cv::line(panel, {0, i * tile}, {columns * tile - 1, i * tile}, kInk);
  return titled(panel, title);
}

}  // namespace

cv::Mat windowPicture(const std::vector<SceneChannels>& windows) {
  std::vector<cv::Mat> rows;
  for (std::size_t i = 0; i < windows.size(); ++i) {
    const SceneChannels& window = windows[i];
    const int zoom = enlargement(window.range_px.width(), window.range_px.height(), kWindowPx);
    const auto map = [&](const Image<float>& values, const ColourScale& scale) {
      const cv::Mat panel = withReferenceSquare(enlarged(colourPixels(values, scale), zoom), zoom);
      return beside({panel, colourBar(scale, panel.rows)});
    };
    const cv::Mat edges =
        withReferenceSquare(enlarged(edgePixels(window.range_px, window.edges), zoom), zoom);
    rows.push_back(titled(beside({map(window.range_px, scaleOf(window.range_px, "range", "px")),
                                  edges,
                                  map(window.distance_px,
                                      signedScaleOf(window.distance_px, "signed distance", "px"))}),
                          "Start " + std::to_string(i + 1) + ": range, edges, signed distance",
                          sizeText(window.range_px.width(), window.range_px.height()) + " of " +
                              number(window.camera.pixel_mm, 3) + " mm"));
  }
  return below(rows);
}

cv::Mat bestViewPicture(const ReferenceObject& object,
                        const std::vector<SceneChannels>& windows,
                        const std::vector<Hypothesis>& hypotheses) {
  checkAtlas(object);
  std::vector<cv::Mat> rows;
  for (std::size_t i = 0; i < windows.size(); ++i) {
    const Hypothesis* best = nullptr;
    for (const Hypothesis& hypothesis : hypotheses) {
      if (hypothesis.window != static_cast<int>(i)) continue;
      RP_CHECK(
          hypothesis.view >= 0 && hypothesis.view < static_cast<int>(object.views.size()),
          "hypothesis of view " + std::to_string(hypothesis.view) + ", which its object lacks");
      if (best == nullptr || hypothesis.error < best->error) best = &hypothesis;
    }
    if (best != nullptr) rows.push_back(bestViewRow(object, windows[i], *best));
  }
  return below(rows);
}

cv::Mat atlasPicture(const ReferenceObject& object, int first, int count) {
  checkAtlas(object);
  const int views = static_cast<int>(object.views.size());
  RP_CHECK(first >= 0 && first < views && count > 0,
           "view " + std::to_string(first) + " of an atlas of " + std::to_string(views));
  const int shown = std::min(count, views - first);
  const auto panel = [&](const std::string& title, const ColourScale& scale, int channel) {
    return atlasPanel(object, first, shown, title, scale, channel);
  };
  const cv::Mat upper = beside({panel("Range", {"range", "px", 0.0f, 0.0f, true, false}, 1),
                                panel("Edges", {"edge", "", 0.0f, 1.0f, false, false}, 2)});
  const cv::Mat lower =
      beside({panel("Signed distance", {"signed distance", "px", 0.0f, 0.0f, false, true}, 0),
              panel("|cos(view, normal)|", {"|cos|", "", 0.0f, 1.0f, true, false}, 3)});
  return titled(
      below({upper, lower}),
      object.mesh.name + ": views " + std::to_string(first) + " to " +
          std::to_string(first + shown - 1) + " of " + std::to_string(views),
      sizeText(object.size, object.size) + " of " + number(object.pixel_mm, 3) + " mm a view");
}

}  // namespace rangepose::debug
