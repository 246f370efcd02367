#include "rangepose/estimate_dump.h"

#include <vector>

#include "rangepose/estimate_report.h"

namespace rangepose::cli {
namespace {

/// An object that found nothing to look at (all is background) has no pictures.
void addObject(debug::StageDump& dump, const ReferenceObject& object, const ObjectTrace& trace) {
  if (trace.scene.range_px.empty()) return;
  dump.addRange(trace.scene.camera, trace.raw_range_px);
  dump.addChannels(trace.scene);
  dump.addPatches(trace.labels);
  dump.addSeeds(trace.scene, trace.seeds);
  if (!trace.windows.empty()) dump.addWindows(trace.windows);
  dump.addAtlas(object);
  if (trace.hypotheses.empty()) return;
  dump.addErrors(object, trace.hypotheses);
  dump.addBestViews(object, trace.windows, trace.hypotheses);
}

}  // namespace

void finishDump(debug::StageDump& dump,
                const DepthImage& depth,
                const ReferenceDatabase& database,
                const Estimate& estimate,
                const EstimateTrace& trace) {
  dump.addKeepMask(depth, trace.foreground);
  std::vector<std::size_t> shown = {0};
  if (!estimate.poses.empty() && estimate.poses.front().object != 0) {
    shown.push_back(static_cast<std::size_t>(estimate.poses.front().object));
  }
  for (const std::size_t index : shown) {
    if (index < trace.objects.size())
      addObject(dump, database.objects[index], trace.objects[index]);
  }
  const std::vector<debug::OverlayPose> poses = overlayPoses(estimate, database);
  if (!poses.empty()) {
    dump.addOverlay("rough", depth, overlayPoses(estimate, database, true));
    dump.addOverlay("fine", depth, poses);
  }
  dump.addSensor(estimate.sensor);
  dump.finish(estimate.times, poses);
}

}  // namespace rangepose::cli
