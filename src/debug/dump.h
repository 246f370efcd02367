// A folder with a picture of every stage and a page that shows them in order.
#pragma once

#include <cstdint>
#include <filesystem>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/camera.h"
#include "core/image.h"
#include "core/timings.h"
#include "debug/overlay.h"
#include "stages/reference.h"
#include "stages/scene_channels.h"
#include "stages/search.h"
#include "stages/sensor_facts.h"

namespace rangepose::debug {

/// One picture of the page.
struct DumpEntry {
  std::string file;     ///< in the folder, e.g. "01_depth.png"
  std::string title;    ///< one line
  std::string caption;  ///< what to look for
  int width = 0;        ///< [px]
  int height = 0;       ///< [px]
};

/// Every `add` writes one numbered PNG at once, so that a run that fails later leaves what came
/// before; finish() writes index.html. Files of a former dump with the same names are replaced,
/// each whole or not at all; other files are left alone. All functions throw Error, naming the
/// file, when they cannot write.
class StageDump {
 public:
  /// Makes the folder if there is none.
  StageDump(std::filesystem::path directory, std::string title);

  void addDepth(const DepthImage& image);
  /// `keep` as in host::resample: 0 is background, empty keeps all.
  void addKeepMask(const DepthImage& image, const Image<std::uint8_t>& keep);
  /// The range image as resampled, before the median.
  void addRange(const OrthoCamera& camera, const Image<float>& range_px);
  /// Three pictures: range after the median, edges, signed distance.
  void addChannels(const SceneChannels& channels);
  void addPatches(const Image<std::int32_t>& labels);
  void addSeeds(const SceneChannels& channels, const std::vector<Seed>& seeds);
  /// What the search sees around each start.
  void addWindows(const std::vector<SceneChannels>& windows);
  void addAtlas(const ReferenceObject& object, int first = 0, int count = 64);
  /// Sorted errors a start, and the lowest error over the directions of view.
  void addErrors(const ReferenceObject& object, const std::vector<Hypothesis>& hypotheses);
  /// The best view of each window laid over it; hypotheses name windows by index.
  void addBestViews(const ReferenceObject& object,
                    const std::vector<SceneChannels>& windows,
                    const std::vector<Hypothesis>& hypotheses);
  /// `name`, e.g. "rough" or "fine", becomes part of file name and title.
  void addOverlay(const std::string& name,
                  const DepthImage& image,
                  const std::vector<OverlayPose>& poses,
                  const OverlayOptions& options = {});
  /// Any other picture.
  void addPicture(const std::string& name,
                  const std::string& title,
                  const std::string& caption,
                  const cv::Mat& picture);

  /// What the image tells of its sensor: a table of index.html.
  void addSensor(const SensorFacts& sensor) { sensor_ = sensor; }

  /// Writes index.html with all pictures so far, the final poses and the times.
  void finish(const StageTimes& times, const std::vector<OverlayPose>& poses) const;

  const std::vector<DumpEntry>& entries() const { return entries_; }
  const std::filesystem::path& directory() const { return directory_; }

 private:
  std::filesystem::path directory_;
  std::optional<SensorFacts> sensor_;
  std::string title_;
  std::vector<DumpEntry> entries_;
};

/// The text of index.html: one file, no scripts, nothing from elsewhere.
std::string dumpPage(const std::string& title,
                     const std::vector<DumpEntry>& entries,
                     const StageTimes& times,
                     const std::vector<OverlayPose>& poses,
                     const std::optional<SensorFacts>& sensor = {});

}  // namespace rangepose::debug
