#include "rangepose/estimate_report.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "core/error.h"

namespace rangepose::cli {
namespace {

using Json = nlohmann::ordered_json;

double finite(double value, const char* field) {
  if (!std::isfinite(value)) {
    throw Error(std::string("result: ") + field +
                " is not a finite number; please report this image");
  }
  return value;
}

Json vectorJson(const glm::dvec3& vector, const char* field) {
  Json list = Json::array();
  for (int axis = 0; axis < 3; ++axis) list.push_back(finite(vector[axis], field));
  return list;
}

Json rotationJson(const Pose& pose) {
  Json rows = Json::array();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      rows.push_back(finite(pose.rotation[column][row], "cam_R_m2c"));
    }
  }
  return rows;
}

Json checkJson(const CheckResult& check) {
  return {{"explained", finite(check.explained, "check.explained")},
          {"contradicted", finite(check.contradicted, "check.contradicted")},
          {"hidden", finite(check.hidden, "check.hidden")},
          {"buried", finite(check.buried, "check.buried")},
          {"missing", finite(check.missing, "check.missing")},
          {"weak", finite(check.weak, "check.weak")},
          {"outline", finite(check.outline, "check.outline")},
          {"outline_covered", finite(check.outline_covered, "check.outline_covered")},
          {"seen_through", finite(check.seen_through, "check.seen_through")},
          {"relief", finite(check.relief, "check.relief")},
          {"whole_relief", finite(check.whole_relief, "check.whole_relief")},
          {"inner_px", finite(check.inner_px, "check.inner_px")},
          {"explained_mm2", finite(check.explained_mm2, "check.explained_mm2")},
          {"residual_mm", finite(check.residual_mm, "check.residual_mm")}};
}

/// What each term adds to the log odds that the pose is right.
Json evidenceJson(const EvidenceTerms& terms) {
  Json json = Json::object();
  for (std::size_t i = 0; i < kEvidenceTerms; ++i) {
    const char* name = nameOf(static_cast<EvidenceTerm>(i));
    json[name] = finite(terms[i] * evidenceWeights()[i], name);
  }
  return json;
}

Json sensorJson(const SensorFacts& sensor) {
  return {{"noise_mm", finite(sensor.noise_mm, "noise_mm")},
          {"error_mm", finite(sensor.error_mm, "error_mm")},
          {"step_mm", finite(sensor.step_mm, "step_mm")},
          {"jump_px", finite(sensor.jump_px, "jump_px")},
          {"hole_px", finite(sensor.hole_px, "hole_px")},
          {"lost", finite(sensor.lost, "lost")}};
}

std::string sensorLine(const SensorFacts& sensor) {
  return fmt::format(
      "sensor: noise {:.3f} mm, error {:.3f} mm, steps of {:.3g} mm, jumps smeared over {:.1f} px, "
      "{:.1f} px lost "
      "at "
      "a jump, {:.1f} % lost in all\n",
      sensor.noise_mm,
      sensor.error_mm,
      sensor.step_mm,
      sensor.jump_px,
      sensor.hole_px,
      100.0 * sensor.lost);
}

const ReferenceObject& objectOf(const PoseEstimate& pose, const ReferenceDatabase& database) {
  return database.objects.at(static_cast<std::size_t>(pose.object));
}

Json poseJson(std::size_t index, const PoseEstimate& pose, const ReportContext& context) {
  const Pick& pick = context.picks.at(index);
  const ReferenceObject& object = objectOf(pose, context.database);
  return {{"order", index + 1},
          {"object", object.mesh.name},
          {"obj_id", object.id},
          {"score", finite(pose.confidence, "score")},
          {"freedom", finite(pick.freedom, "freedom")},
          {"height_mm", finite(pick.height_mm, "height_mm")},
          {"approach", vectorJson(pick.approach, "approach")},
          {"cam_R_m2c", rotationJson(pose.pose)},
          {"cam_t_m2c", vectorJson(pose.pose.translation_mm, "cam_t_m2c")},
          {"rough",
           {{"R", rotationJson(pose.rough)},
            {"t", vectorJson(pose.rough.translation_mm, "rough.t")},
            {"error", finite(static_cast<double>(pose.rough_error), "rough.error")},
            {"view", pose.view}}},
          {"check", checkJson(pose.check)},
          {"evidence", evidenceJson(pose.evidence)}};
}

std::string poseLine(std::size_t index, const PoseEstimate& pose, const ReportContext& context) {
  const Pick& pick = context.picks.at(index);
  const glm::dvec3& t = pose.pose.translation_mm;
  const std::array<double, 4> q = quaternionOf(pose.pose.rotation);
  return fmt::format(
      "{:>5}  {:<20} {:>6.3f} {:>7.2f} {:>10.1f}  {:>9.2f} {:>9.2f} {:>9.2f}   {:>8.5f} {:>8.5f} "
      "{:>8.5f} {:>8.5f}\n",
      index + 1,
      objectOf(pose, context.database).mesh.name,
      pose.confidence,
      pick.freedom,
      pick.height_mm,
      t.x,
      t.y,
      t.z,
      q[0],
      q[1],
      q[2],
      q[3]);
}

}  // namespace

std::string textReport(const Estimate& estimate, const ReportContext& context) {
  std::string text;
  if (estimate.poses.empty()) {
    text = context.found > 0
               ? fmt::format("{} poses found, none of them within reach\n", context.found)
               : fmt::format("no pose found with a score of at least {:g}\n", context.min_score);
  } else {
    text = fmt::format(
        "{:>5}  {:<20} {:>6} {:>7} {:>10}  {:>9} {:>9} {:>9}   {:>8} {:>8} {:>8} {:>8}\n",
        "order",
        "object",
        "score",
        "freedom",
        "height[mm]",
        "x[mm]",
        "y[mm]",
        "z[mm]",
        "qw",
        "qx",
        "qy",
        "qz");
  }
  for (std::size_t i = 0; i < estimate.poses.size(); ++i) {
    text += poseLine(i, estimate.poses[i], context);
  }
  text += sensorLine(estimate.sensor);
  double total = 0.0;
  text += "path " + context.path + ", times [ms]:";
  for (const StageTime& time : estimate.times) {
    text += fmt::format(" {} {:.1f},", time.stage, time.ms);
    total += time.ms;
  }
  return text + fmt::format(" total {:.1f}\n", total);
}

Json timesJson(const StageTimes& times) {
  Json list = Json::object();
  for (const StageTime& time : times) list[time.stage] = finite(time.ms, "times_ms");
  return list;
}

Json jsonReport(const Estimate& estimate, const ReportContext& context) {
  Json poses = Json::array();
  for (std::size_t i = 0; i < estimate.poses.size(); ++i) {
    poses.push_back(poseJson(i, estimate.poses[i], context));
  }
  return {{"version", RP_VERSION},
          {"path", context.path},
          {"image", context.image},
          {"poses", poses},
          {"out_of_reach", context.found - estimate.poses.size()},
          {"times_ms", timesJson(estimate.times)},
          {"sensor", sensorJson(estimate.sensor)},
          {"warnings", estimate.warnings}};
}

std::string jsonText(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::vector<debug::OverlayPose> overlayPoses(const Estimate& estimate,
                                             const ReferenceDatabase& database,
                                             bool rough) {
  std::vector<debug::OverlayPose> poses;
  for (const PoseEstimate& pose : estimate.poses) {
    const Mesh& mesh = objectOf(pose, database).mesh;
    poses.push_back({&mesh,
                     rough ? pose.rough : pose.pose,
                     pose.confidence,
                     std::to_string(poses.size() + 1) + " " + mesh.name});
  }
  return poses;
}

}  // namespace rangepose::cli
