#include <algorithm>
#include <string>

#include "core/error.h"
#include "database/reference_database.h"
#include "geometry/flat_faces.h"
#include "geometry/solid.h"
#include "geometry/surface_sample.h"
#include "geometry/twins.h"

namespace rangepose {

ChannelOptions channelOptionsFor(int size_px) {
  ChannelOptions options;
  options.image_width_px = size_px;
  options.edt_passes = std::max(3, size_px * 7 / 64);
  return options;
}

ChannelOptions channelOptionsOf(const ReferenceObject& object) {
  ChannelOptions options;
  options.image_width_px = object.size;
  options.edt_passes = object.edt_passes;
  return options;
}

void measureShape(ReferenceObject& object) {
  object.mesh.solid = isSolid(object.mesh);
  constexpr double kFlat = 0.02;       // of the diameter
  constexpr double kThinSheet = 0.05;  // of the diameter: thicker walls are no sheet
  const std::vector<FlatFace> faces = flatFaces(object.mesh, kFlat * object.diameter_mm);
  object.thickness_mm = thickness(object.mesh);
  const double sheet_mm = sheetThickness(faces);
  if (sheet_mm < kThinSheet * object.diameter_mm)
    object.thickness_mm = std::min(object.thickness_mm, sheet_mm);
  object.flat_face = largestExtent(faces);
}

void setSymmetries(ReferenceObject& object, const Symmetries& symmetries) {
  object.symmetries = symmetries;
  object.twins = findTwins(object.mesh, symmetries);
}

ReferenceObject describeObject(const Mesh& mesh,
                               int id,
                               int size_px,
                               const std::vector<glm::dmat3>& rotations,
                               const ChannelOptions& options) {
  if (size_px < 16 || size_px > 128 || size_px % 8 != 0) {
    throw Error("view size " + std::to_string(size_px) + " px: give a multiple of 8 in 16..128");
  }
  if (rotations.empty() || rotations.size() > 65536) {
    throw Error("number of views " + std::to_string(rotations.size()) + ": give 1..65536");
  }
  checkMesh(mesh);
  ReferenceObject object;
  object.id = id;
  object.mesh = mesh;
  const Sphere sphere = boundingSphere(mesh);
  object.center_mm = sphere.center_mm;
  object.radius_mm = sphere.radius_mm;
  object.diameter_mm = diameter(mesh);
  measureShape(object);
  object.size = size_px;
  object.edt_passes = options.edt_passes;
  object.pixel_mm = 2.0 * sphere.radius_mm / (size_px - 2.0 * kTileMarginPx);
  object.views.resize(rotations.size());
  for (std::size_t i = 0; i < rotations.size(); ++i) object.views[i].rotation = rotations[i];
  return object;
}

}  // namespace rangepose
