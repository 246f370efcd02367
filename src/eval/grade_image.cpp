#include "eval/grade_image.h"

#include <limits>

namespace rangepose {
namespace {

// Errors from here on are wrong by any threshold and need not be exact.
constexpr double kMssdLimit = 0.5;
constexpr double kMspdLimitPx = 50.0;
/// Rotation and translation are given for poses closer than this [diameters].
constexpr double kDetailLimit = 0.1;
/// Width of the image that MSPD is scaled to [px].
constexpr double kMspdWidth = 640.0;

std::vector<PosedModel> renderAll(const std::vector<Pose>& poses,
                                  const ErrorModel& model,
                                  const Camera& camera) {
  std::vector<PosedModel> rendered;
  rendered.reserve(poses.size());
  for (const Pose& pose : poses) rendered.push_back(renderPosed(model.mesh(), camera, pose));
  return rendered;
}

}  // namespace

void fillErrors(ImageGrading& grading,
                const ErrorModel& model,
                const Camera& camera,
                const Image<float>& measured_mm,
                const VsdOptions& vsd) {
  const int columns = static_cast<int>(grading.truths.size());
  const int rows = static_cast<int>(grading.estimates.size());
  ObjectErrors& errors = grading.errors;
  const PairErrors infinite(columns, rows, std::numeric_limits<double>::infinity());
  errors.mssd = errors.mspd_px = errors.rotation_rad = errors.translation_mm = infinite;
  errors.vsd.assign(vsd.taus.size(), infinite);
  errors.unlike = infinite;
  if (infinite.empty()) return;
  const std::vector<PosedModel> seen = renderAll(grading.estimates, model, camera);
  const std::vector<PosedModel> real = renderAll(grading.truths, model, camera);
  const double mspd_scale = camera.width / kMspdWidth;
  for (int row = 0; row < rows; ++row) {
    const auto e = static_cast<std::size_t>(row);
    for (int column = 0; column < columns; ++column) {
      const auto t = static_cast<std::size_t>(column);
      const Pose& estimate = grading.estimates[e];
      const Pose& truth = grading.truths[t];
      const double mssd = mssdErrorMm(model, estimate, truth, kMssdLimit * model.diameterMm());
      errors.mssd.at(column, row) = mssd / model.diameterMm();
      errors.mspd_px.at(column, row) =
          mspdErrorPx(model, camera, estimate, truth, kMspdLimitPx * mspd_scale) / mspd_scale;
      const std::vector<double> vsds =
          vsdErrors(measured_mm, seen[e], real[t], model.diameterMm(), vsd);
      for (std::size_t i = 0; i < vsds.size(); ++i) errors.vsd[i].at(column, row) = vsds[i];
      errors.unlike.at(column, row) =
          unlikeness(measured_mm, seen[e], real[t], kLookApart * model.diameterMm());
      if (!(errors.mssd.at(column, row) < kDetailLimit)) continue;
      errors.rotation_rad.at(column, row) = rotationErrorRad(model, estimate, truth);
      errors.translation_mm.at(column, row) = translationErrorMm(model, estimate, truth);
    }
  }
}

}  // namespace rangepose
