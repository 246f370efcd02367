#include "pipeline/foreground_task.h"

#include <algorithm>

namespace rangepose {

ForegroundTask foregroundTaskFor(const ReferenceDatabase& database,
                                 const std::optional<BinBox>& bin) {
  ForegroundTask task;
  ForegroundOptions& options = task.options;
  options.part_mm = 0.0;
  for (const ReferenceObject& object : database.objects) {
    options.part_mm = std::max(options.part_mm, object.diameter_mm);
    PlaneExtent& face = options.flat_face;
    face.length_mm = std::max(face.length_mm, object.flat_face.length_mm);
    face.width_mm = std::max(face.width_mm, object.flat_face.width_mm);
  }
  options.tolerance_mm = std::max(1.5, 0.02 * options.part_mm);
  task.thin_mm = options.tolerance_mm;
  for (const ReferenceObject& object : database.objects)
    task.thin_mm = std::min(task.thin_mm, object.finerIfThin(options.tolerance_mm));
  task.bin = bin;
  return task;
}

}  // namespace rangepose
