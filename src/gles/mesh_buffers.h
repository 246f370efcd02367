// A mesh on the device: corners of its triangles with the normals of their faces.
#pragma once

#include <cstdint>
#include <memory>

#include "core/kept.h"
#include "geometry/mesh.h"
#include "gles/buffer.h"

namespace rangepose::gles {

/// Attributes 0: position [mm] relative to center_mm(), 1: unit normal of the face. Three vertices
/// a triangle, since vertices of neighbouring faces differ in the normal. Triangles without area
/// are left out.
class MeshBuffers {
 public:
  explicit MeshBuffers(const Mesh& mesh);

  const VertexArray& vertices() const { return vertices_; }
  /// Adds its attributes to a vertex array that has others too.
  void addTo(VertexArray& vertices) const;
  int corners() const { return corners_; }
  /// Centre of the bounding sphere: positions relative to it keep the float's precision near the
  /// object.
  const glm::dvec3& center_mm() const { return sphere_.center_mm; }
  double radius_mm() const { return sphere_.radius_mm; }

 private:
  Sphere sphere_;
  int corners_ = 0;
  Buffer buffer_;
  VertexArray vertices_;
};

/// Keeps the buffers of each mesh that was asked for.
class ResidentMeshes {
 public:
  /// By content, so that a changed mesh at the same address is noticed.
  std::shared_ptr<const MeshBuffers> of(const Mesh& mesh);

 private:
  Kept<std::uint64_t, MeshBuffers> meshes_{256};
};

}  // namespace rangepose::gles
