// Where no part can be: under the floor or table, in and behind the walls of a bin.
#pragma once

#include <optional>
#include <vector>

#include "core/camera.h"
#include "database/reference_database.h"
#include "stages/foreground.h"

namespace rangepose {

/// A part may be outside by so much [share of its diameter]: as far as a bin may be from where it
/// is said to be, and a pose from where it will be.
inline constexpr double kEnclosureMargin = 0.05;

class Enclosure {
 public:
  /// The depth image must outlive it; `noise_mm` is that of the image. Without planes and bin
  /// nothing is outside.
  Enclosure(const DepthImage& depth,
            std::vector<BackgroundPlane> planes,
            const std::optional<BinBox>& bin,
            const ReferenceDatabase& database,
            double noise_mm);

  /// How far a point of the camera frame lies outside [mm]; negative inside. What rises above a bin
  /// may reach over its walls.
  double beyondMm(const glm::dvec3& point) const;

  /// Share of the surface of a posed object, 0..1, that lies clearly outside although the data in
  /// front of it is inside: only by passing through floor or wall does a part get there.
  double outsideShare(int object, const Pose& camera_from_object) const;

  /// Whether that share is small, by a few points: for many poses that are still to be aligned.
  /// Each may be `off_mm` from where it will be.
  bool holds(int object, const Pose& camera_from_object, double off_mm) const;

 private:
  /// What is known of an object.
  struct Part {
    glm::dvec3 center_mm;            ///< of its bounding sphere, in its frame
    double radius_mm;                ///< of that sphere
    double margin_mm;                ///< what is outside by less may be inside
    std::vector<glm::dvec3> points;  ///< on its surface, in its frame; any first ones are even
  };
  double outsideShare(const Part& part,
                      const Pose& camera_from_object,
                      double margin_mm,
                      int points) const;

  const DepthImage& depth_;
  std::vector<BackgroundPlane> planes_;
  std::optional<BinBox> bin_;
  Pose bin_from_camera_;
  std::vector<Part> parts_;  ///< by object
};

}  // namespace rangepose
