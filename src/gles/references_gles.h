// Renders the reference range images of an object (paper Sect. 4.1).
#pragma once

#include <functional>

#include "gles/context.h"
#include "stages/reference.h"
#include "stages/scene_channels.h"

namespace rangepose::gles {

/// Called after each batch with the number of views that are ready.
using RenderProgress = std::function<void(int done, int total)>;

/// Fills `object.atlas`, `object.edt_passes`, and box, area_px and anchor_px of each view. Given
/// are mesh, center_mm, radius_mm, pixel_mm, size and the rotation of each view.
///
/// The sphere must fit into a tile. Throws Error where it does not, or where a view shows no pixel.
void renderReferences(Context& context,
                      ReferenceObject& object,
                      const ChannelOptions& options,
                      const RenderProgress& progress = {});

}  // namespace rangepose::gles
