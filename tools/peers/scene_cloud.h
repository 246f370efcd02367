// A depth image as the peers want it: points with normals, thinned, and places to look at.
#pragma once

#include <cstdint>
#include <vector>

#include "core/camera.h"
#include "stages/surface_points.h"

namespace rangepose::peers {

/// Points in one frame, with unit normals towards the viewer; which frame says who gives them.
using Cloud = std::vector<SurfacePoint>;

/// The measured pixels of the mask in the camera frame [mm]. Normals are those of a plane through
/// the `reach` pixels around each that lie on the same surface; pixels with too few of them (at
/// edges, between holes) are left out.
Cloud cloudOf(const DepthImage& image, const Image<std::uint8_t>& keep, int reach);

/// One point for all that lie in a cube of `cell_mm` and look the same way: their mean. In the
/// order of the cubes, whatever the order of the points.
Cloud thinned(const Cloud& cloud, double cell_mm);

/// Points of the cloud, each as far as possible from those before (farthest-point sampling), until
/// they are nearer than `apart_mm` or `most` in number. The first is the one nearest to the camera.
std::vector<glm::dvec3> spreadSeeds(const Cloud& cloud, double apart_mm, int most);

/// The points within `radius_mm` of the centre.
Cloud cropped(const Cloud& cloud, const glm::dvec3& center_mm, double radius_mm);

}  // namespace rangepose::peers
