// The rough search on GLES: three programs in lockstep over all views (paper Sect. 6, Fig. 9).
#pragma once

#include <vector>

#include "gles/device.h"
#include "stages/reference.h"
#include "stages/search.h"

namespace rangepose::gles {

/// An object's atlas and the buffers that its search needs, on the device.
class ResidentObject {
 public:
  explicit ResidentObject(const ReferenceObject& object);

  int views() const { return views_; }
  int size() const { return size_; }
  int columns() const { return columns_; }
  float outsideDistance() const { return outside_distance_; }
  const Texture& atlas() const { return atlas_; }
  const VertexArray& boxes() const { return box_vertices_; }
  /// Sums of 2^k x 2^k pixels of each tile; zero outside of the boxes, whatever was drawn before.
  const Canvas& level(int k) const;
  int lastLevel() const;  ///< in which a tile is one texel

 private:
  int views_;
  int size_;
  int columns_;
  float outside_distance_;
  Texture atlas_;
  Buffer boxes_;
  VertexArray box_vertices_;
  std::vector<Canvas> levels_;
};

/// A scene window on the device.
struct WindowTextures {
  const Texture& range_px;
  const Texture& distance_px;
};

std::vector<ErrorTerms> errorTerms(Device& device,
                                   const ResidentObject& object,
                                   const WindowTextures& window,
                                   const std::vector<glm::vec3>& translations_px,
                                   const ErrorOptions& options);

/// One simplex step of each state with a given value.
std::vector<SimplexState> simplexSteps(Device& device,
                                       const std::vector<SimplexState>& states,
                                       const std::vector<float>& values,
                                       const SimplexOptions& options);

/// One hypothesis a view. `starts_px` and `area_factors` have one entry a view.
std::vector<Hypothesis> search(Device& device,
                               const ResidentObject& object,
                               const WindowTextures& window,
                               const std::vector<glm::vec3>& starts_px,
                               const std::vector<float>& area_factors,
                               const SearchOptions& options);

}  // namespace rangepose::gles
