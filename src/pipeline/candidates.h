// What the selection of candidates and their refinement share.
#pragma once

#include "pipeline/refine.h"

namespace rangepose {

/// The check of a pose of the object in an image with that depth noise [mm].
CheckOptions checkOptionsFor(const ReferenceObject& object, double noise_mm);
/// The check of a pose before its alignment, with a tolerance as wide as such a pose is wrong.
CheckOptions glanceOptionsFor(const ReferenceObject& object, double noise_mm);

/// Enough of a surface to be judged by [px].
inline constexpr int kRenderPx = 112;
/// What the camera would see of the posed object, to be judged, or aligned once the task says how;
/// in a window of at most `most_px` a side.
RenderTask surfaceTask(const ReferenceObject& object,
                       const Pose& camera_from_object,
                       const Camera& camera,
                       double noise_mm,
                       int most_px = kRenderPx);

/// Of a view: enough for a glance at many poses.
inline constexpr int kFewPoints = 40;

/// Area of a view [mm^2].
double visibleArea(const ReferenceObject& object, int view);
/// Mean area of the object's views [mm^2].
double meanVisibleArea(const ReferenceObject& object);

/// Sets check and rank. Of two poses that fit equally well the one that explains more of the scene
/// is the better explanation: a part's face alone can be laid on many surfaces.
void setVerdict(Candidate& candidate, const CheckResult& check, double mean_visible_mm2);
/// Changes a term of the evidence of a pose, and with it rank and confidence.
void setTerm(Candidate& candidate, EvidenceTerm term, double value);
/// Sets the check of a pose that was rendered, its evidence, and what follows from that.
void setEvidence(Candidate& candidate, const CheckResult& check, double mean_visible_mm2);

}  // namespace rangepose
