// Reference range images of the objects that may be in a scene (paper Sect. 4).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/glm.h"
#include "core/image.h"
#include "core/pose.h"
#include "geometry/flat_faces.h"
#include "geometry/mesh.h"
#include "geometry/symmetry.h"

namespace rangepose {

/// One orientation of an object, seen by an orthographic camera.
///
/// View frame: x right, y down, z away from the viewer, origin at the centre of the object's
/// bounding sphere. x_view = rotation * (x_object - center_mm).
struct ReferenceView {
  glm::dmat3 rotation{1.0};  ///< view_from_object
  PixelBox box;              ///< smallest box around the object's pixels, in its tile [px]
  float area_px = 0.0f;      ///< number of pixels that show the object [px^2]
  glm::vec3 anchor_px{
      0.0f};  ///< pixel with the largest EDT value: u, v in its tile, and its range [px]
};

/// Texel of the atlas (paper Sect. 4.1).
/// r: signed distance to the nearest edge [px], > 0 on the object; g: range [px], 0 = background;
/// b: 1 on an edge; a: |cos(view, normal)|, 0 = background.
///
/// Range is measured from a plane `size` pixels in front of the sphere's centre, so it is positive
/// on the object: range = z_view / pixel_mm + size.
using ReferenceTexel = glm::vec4;

/// Never the same twice in a process.
std::uint64_t newReferenceSerial();

struct ReferenceObject {
  /// Another one whenever the views were rendered or read: what caches of an object go by.
  std::uint64_t serial = newReferenceSerial();
  int id = 1;                 ///< BOP object id
  Mesh mesh;                  ///< [mm], in the object's own frame
  Symmetries symmetries;      ///< rotations that leave it the same; empty: none, or not looked for
  std::vector<Pose> twins;    ///< other ways round that are nearly the same (geometry/twins.h)
  glm::dvec3 center_mm{0.0};  ///< centre of the bounding sphere, in the object's frame [mm]
  double radius_mm = 0.0;     ///< of that sphere [mm]
  double diameter_mm = 0.0;   ///< largest distance between two vertices [mm]
  double thickness_mm = 0.0;  ///< smallest extent, of sheet metal that of the sheet; 0: not known
  PlaneExtent flat_face;      ///< largest length and width of its flat faces; 0: not known
  double pixel_mm = 0.0;      ///< width of a pixel of a view [mm]
  int size = 64;              ///< a tile is size x size pixels
  int edt_passes = 0;         ///< passes of the distance transform: EDT values reach edt_passes + 1
  std::vector<ReferenceView> views;  ///< view i lies in tile i
  Image<ReferenceTexel> atlas;       ///< tiles in rows of `columns()`

  /// A tolerance [mm] made finer where the object is so thin that its faces would be confused with
  /// each other or with the table it lies on.
  double finerIfThin(double coarse_mm) const {
    constexpr double kShareOfThickness = 0.3;
    const double thin_mm = kShareOfThickness * thickness_mm;
    return thickness_mm > 0.0 && thin_mm < coarse_mm ? thin_mm : coarse_mm;
  }
  int columns() const { return size > 0 ? atlas.width() / size : 0; }
  /// Upper left pixel of the tile of view `index` in the atlas.
  glm::ivec2 tileOrigin(int index) const {
    const int per_row = columns() > 0 ? columns() : 1;
    return {index % per_row * size, index / per_row * size};
  }
  float maxArea() const;    ///< of the views [px^2]
  double meanArea() const;  ///< of the views [px^2]
};

/// Number of tile columns of an atlas of `views` tiles: the smallest square that holds them.
int atlasColumns(int views);

}  // namespace rangepose
