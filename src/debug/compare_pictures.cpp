#include "debug/compare_pictures.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "debug/canvas.h"
#include "debug/colour.h"

namespace rangepose::debug {
namespace {

constexpr int kPanelPx = 420;

bool sameSize(const Image<float>& a, const Image<float>& b) {
  return a.width() == b.width() && a.height() == b.height();
}

/// NaN is equal to NaN: both have no value there.
bool equal(float a, float b) { return a == b || (std::isnan(a) && std::isnan(b)); }

float gap(float reference, float subject, ComparedStage::Kind kind) {
  if (equal(reference, subject)) return 0.0f;
  return kind == ComparedStage::Kind::kLabels ? 1.0f : subject - reference;
}

Image<float> gaps(const Image<float>& reference,
                  const Image<float>& subject,
                  ComparedStage::Kind kind) {
  Image<float> result(reference.width(), reference.height());
  for (std::size_t i = 0; i < reference.size(); ++i) {
    result.data()[i] = gap(reference.data()[i], subject.data()[i], kind);
  }
  return result;
}

cv::Mat labelPanel(const Image<float>& labels) {
  Image<std::int32_t> whole(labels.width(), labels.height());
  std::transform(labels.begin(), labels.end(), whole.begin(), [](float label) {
    return static_cast<std::int32_t>(label);
  });
  return enlarged(labelPixels(whole), enlargement(labels.width(), labels.height(), kPanelPx));
}

ColourScale scaleFor(const ComparedStage& stage) {
  const Image<float>& reference = stage.images.front();
  return stage.kind == ComparedStage::Kind::kSigned
             ? signedScaleOf(reference, stage.name, stage.unit)
             : scaleOf(reference, stage.name, stage.unit);
}

cv::Mat valuePanel(const ComparedStage& stage, const Image<float>& image) {
  if (image.empty()) return {};
  if (stage.kind == ComparedStage::Kind::kLabels) return labelPanel(image);
  return colourMap(image, scaleFor(stage), kPanelPx);
}

std::string noteOf(const Difference& difference, const ComparedStage& stage) {
  if (difference.pixels == 0) return "equal in all " + std::to_string(difference.all) + " pixels";
  std::string note = std::to_string(difference.pixels) + " of " + std::to_string(difference.all) +
                     " pixels differ";
  if (stage.kind == ComparedStage::Kind::kLabels) return note;
  return note + ", by at most " + number(difference.largest, 6) + " " + stage.unit;
}

cv::Mat differencePanel(const ComparedStage& stage, const Image<float>& subject) {
  const Image<float>& reference = stage.images.front();
  const Difference difference = differenceOf(reference, subject);
  cv::Mat panel;
  if (sameSize(reference, subject) && !reference.empty()) {
    const Image<float> values = gaps(reference, subject, stage.kind);
    const std::string unit = stage.kind == ComparedStage::Kind::kLabels ? "" : stage.unit;
    panel = colourMap(values, signedScaleOf(values, "difference", unit), kPanelPx);
  }
  return titled(panel, "difference", noteOf(difference, stage));
}

}  // namespace

Difference differenceOf(const Image<float>& reference, const Image<float>& subject) {
  Difference result;
  result.all = std::max(reference.size(), subject.size());
  if (!sameSize(reference, subject)) {
    result.pixels = result.all;
    return result;
  }
  for (std::size_t i = 0; i < reference.size(); ++i) {
    const float a = reference.data()[i];
    const float b = subject.data()[i];
    if (equal(a, b)) continue;
    ++result.pixels;
    const double size = std::abs(static_cast<double>(b) - static_cast<double>(a));
    if (size > result.largest) result.largest = size;
  }
  return result;
}

cv::Mat comparisonPicture(const std::vector<std::string>& paths,
                          const std::vector<ComparedStage>& stages) {
  std::vector<cv::Mat> rows;
  for (const ComparedStage& stage : stages) {
    RP_CHECK(!paths.empty() && stage.images.size() == paths.size(),
             "stage " + stage.name + ": one image a path is needed");
    std::vector<cv::Mat> panels;
    for (std::size_t i = 0; i < paths.size(); ++i) {
      const Image<float>& image = stage.images[i];
      panels.push_back(titled(valuePanel(stage, image),
                              stage.name + ", " + paths[i],
                              sizeText(image.width(), image.height())));
      if (i > 0) panels.push_back(differencePanel(stage, image));
    }
    rows.push_back(beside(panels));
  }
  return framed(below(rows, 2 * kGapPx));
}

}  // namespace rangepose::debug
