// Rendering of the reference views on the host (paper Sect. 4.1). The database is built by
// gles::renderReferences; this twin checks it, and builds where there is no EGL.
#pragma once

#include <functional>

#include "stages/reference.h"
#include "stages/scene_channels.h"

namespace rangepose {

/// The camera and pose that show a view in its tile: range [px] = depth [mm] / pixel_mm.
Camera tileCamera(const ReferenceObject& object);
Pose tilePose(const ReferenceObject& object, const glm::dmat3& view_from_object);

/// Fills box, area and anchor of a view from its tile in the atlas.
void describeTile(ReferenceObject& object, int view);

namespace host {

/// Renders object.views into object.atlas. `progress(done, total)` is called now and then by one
/// thread at a time; it may be empty.
void renderReferences(ReferenceObject& object,
                      const ChannelOptions& options,
                      const std::function<void(int done, int total)>& progress);

}  // namespace host
}  // namespace rangepose
