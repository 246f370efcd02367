// Renders a posed mesh as a camera sees it. Twin: host::renderSurface in src/stages/surface.h.
#pragma once

#include "gles/device.h"
#include "gles/mesh_buffers.h"
#include "stages/surface.h"

namespace rangepose::gles {

/// `buffers` hold `mesh`. Triangles that reach behind the camera are left out.
Canvas renderSurface(Device& device,
                     const Mesh& mesh,
                     const MeshBuffers& buffers,
                     const Camera& camera,
                     const Pose& camera_from_object,
                     const SurfaceWindow& window);

/// The same into a part of a target with a depth buffer, which the caller has cleared. `box` is as
/// large as the window.
void renderSurface(Device& device,
                   const Framebuffer& target,
                   const PixelBox& box,
                   const Mesh& mesh,
                   const MeshBuffers& buffers,
                   const Camera& camera,
                   const Pose& camera_from_object,
                   const SurfaceWindow& window);

}  // namespace rangepose::gles
