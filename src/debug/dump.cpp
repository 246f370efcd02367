#include "debug/dump.h"

#include <cctype>
#include <system_error>

#include "core/error.h"
#include "debug/canvas.h"
#include "debug/plots.h"
#include "debug/stage_pictures.h"
#include "io/atomic_file.h"

namespace rangepose::debug {
namespace {

/// Letters and digits of a name in lower case, everything else as single underscores.
std::string fileStem(const std::string& name) {
  std::string stem;
  for (const char c : name) {
    const auto byte = static_cast<unsigned char>(c);
    if (std::isalnum(byte) != 0 && byte < 128) {
      stem += static_cast<char>(std::tolower(byte));
    } else if (!stem.empty() && stem.back() != '_') {
      stem += '_';
    }
  }
  while (!stem.empty() && stem.back() == '_') stem.pop_back();
  return stem.empty() ? "picture" : stem;
}

std::string objectText(const ReferenceObject& object) {
  return object.mesh.name.empty() ? "object " + std::to_string(object.id) : object.mesh.name;
}

}  // namespace

StageDump::StageDump(std::filesystem::path directory, std::string title)
    : directory_(std::move(directory)), title_(std::move(title)) {
  std::error_code failure;
  std::filesystem::create_directories(directory_, failure);
  if (failure || !std::filesystem::is_directory(directory_)) {
    const std::string reason = failure ? failure.message() : "a file is in the way";
    throw Error("cannot make the dump folder " + directory_.string() + ": " + reason +
                "; name a folder that can be written");
  }
}

void StageDump::addPicture(const std::string& name,
                           const std::string& title,
                           const std::string& caption,
                           const cv::Mat& picture) {
  const std::string count = std::to_string(entries_.size() + 1);
  const std::string file = (count.size() < 2 ? "0" : "") + count + "_" + fileStem(name) + ".png";
  const cv::Mat page = picture.empty() ? framed(titled({}, "nothing to show")) : framed(picture);
  writePng(directory_ / file, page);
  entries_.push_back({file, title, caption, page.cols, page.rows});
}

void StageDump::addDepth(const DepthImage& image) {
  addPicture(
      "depth",
      "Depth image",
      "What the sensor measured. Holes are violet in the relief and dark grey in the colours.",
      depthPicture(image));
}

void StageDump::addKeepMask(const DepthImage& image, const Image<std::uint8_t>& keep) {
  addPicture("background",
             "Background",
             "Ochre pixels are taken for bin, table or surroundings and do not reach the search.",
             keepMaskPicture(image, keep));
}

void StageDump::addRange(const OrthoCamera& camera, const Image<float>& range_px) {
  addPicture("range",
             "Orthographic range image",
             "The kept points seen by parallel rays, " + number(camera.pixel_mm, 3) +
                 " mm a pixel; range in the same unit.",
             rangePicture(range_px));
}

void StageDump::addChannels(const SceneChannels& channels) {
  addPicture("median",
             "After the median",
             "Single wrong pixels are gone; edges have stayed where they were.",
             rangePicture(channels.range_px));
  addPicture("edges",
             "Edges",
             "Where the range jumps. Outlines of parts should be closed, surfaces free of specks.",
             edgePicture(channels.range_px, channels.edges));
  addPicture("distance",
             "Signed distance to edges",
             "Positive on surfaces, negative on background, limited by the number of passes.",
             distancePicture(channels.distance_px));
}

void StageDump::addPatches(const Image<std::int32_t>& labels) {
  addPicture("patches",
             "Patches",
             "Connected surfaces without an edge inside. A part should be one or a few of them.",
             patchPicture(labels));
}

void StageDump::addSeeds(const SceneChannels& channels, const std::vector<Seed>& seeds) {
  addPicture("starts",
             "Starts of the search",
             "The most inner pixel of each chosen patch; the circle reaches to the nearest edge.",
             seedPicture(channels.range_px, seeds));
}

void StageDump::addWindows(const std::vector<SceneChannels>& windows) {
  addPicture(
      "windows",
      "Windows of the starts",
      "What the search sees around each start. The white square is as large as a view of the "
      "object; the part should fit into it.",
      windowPicture(windows));
}

void StageDump::addAtlas(const ReferenceObject& object, int first, int count) {
  addPicture("atlas_" + objectText(object),
             "Views of " + objectText(object),
             "A page of the reference views that are compared with the scene.",
             atlasPicture(object, first, count));
}

void StageDump::addErrors(const ReferenceObject& object,
                          const std::vector<Hypothesis>& hypotheses) {
  addPicture("errors_" + objectText(object),
             "Errors of the views of " + objectText(object),
             "A clear winner is a curve that starts far below its median, and one small dark "
             "region on the "
             "map; several such regions are symmetries or look-alikes.",
             below({titled(sortedErrorPlot(hypotheses), "Error of the views, in ascending order"),
                    titled(errorOverDirections(object, hypotheses),
                           "Lowest error over the direction of view")}));
}

void StageDump::addBestViews(const ReferenceObject& object,
                             const std::vector<SceneChannels>& windows,
                             const std::vector<Hypothesis>& hypotheses) {
  addPicture(
      "best_views_" + objectText(object),
      "Best view of " + objectText(object) + " at each start",
      "Left the scene with the outline of the view, then the range that the view predicts, right "
      "their difference: red where the scene lies behind the view, blue where it lies before it.",
      bestViewPicture(object, windows, hypotheses));
}

void StageDump::addOverlay(const std::string& name,
                           const DepthImage& image,
                           const std::vector<OverlayPose>& poses,
                           const OverlayOptions& options) {
  addPicture(
      "overlay_" + name,
      "Overlay: " + name,
      "Green where data and model agree. Red says that the sensor saw through the model: the pose "
      "is wrong there. Blue is covered by something nearer and proves nothing.",
      drawOverlay(image, poses, options).image);
}

void StageDump::finish(const StageTimes& times, const std::vector<OverlayPose>& poses) const {
  const std::string page = dumpPage(title_, entries_, times, poses, sensor_);
  writeFileAtomically(directory_ / "index.html", page);
}

}  // namespace rangepose::debug
