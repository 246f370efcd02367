// A rendered surface: what a camera would see of a posed mesh.
#pragma once

#include "core/camera.h"
#include "core/glm.h"
#include "core/image.h"
#include "core/pose.h"
#include "geometry/mesh.h"

namespace rangepose {

/// xyz: unit normal of the face seen, in the camera frame, turned towards the camera; w: depth
/// along z [mm], 0 where the mesh is not seen.
using SurfaceTexel = glm::vec4;

/// The part of an image plane that is rendered. Pixel (i, j) of the result shows camera pixel
/// (x0 + i * step, y0 + j * step).
struct SurfaceWindow {
  int x0 = 0;      ///< [px of the camera]
  int y0 = 0;      ///< [px of the camera]
  int width = 0;   ///< [px of the result]
  int height = 0;  ///< [px of the result]
  int step = 1;    ///< camera pixels per result pixel
};

/// The window that holds the projection of a sphere around the object, clipped to the camera's
/// image; width 0 when it is not seen. `max_pixels` limits width and height by raising `step`.
SurfaceWindow windowAround(const Camera& camera,
                           const glm::dvec3& center_mm,
                           double radius_mm,
                           int max_pixels);

/// The same without the clipping: for judging a part that the border of the image cuts. Width 0
/// when nothing of the sphere is in the image.
SurfaceWindow wholeWindowAround(const Camera& camera,
                                const glm::dvec3& center_mm,
                                double radius_mm,
                                int max_pixels);

namespace host {

/// Software rasteriser: same result as gles::SurfaceRenderer but for pixels on the borders of
/// triangles. Triangles that reach behind the camera are left out.
Image<SurfaceTexel> renderSurface(const Mesh& mesh,
                                  const Camera& camera,
                                  const Pose& camera_from_object,
                                  const SurfaceWindow& window);

}  // namespace host
}  // namespace rangepose
