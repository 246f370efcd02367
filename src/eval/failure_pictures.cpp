#include "eval/failure_pictures.h"

#include <fmt/format.h>

#include <numbers>

#include "debug/overlay.h"

namespace rangepose {

std::string likelyCause(const Trial& trial) {
  constexpr double kLittle = 0.3;
  constexpr double kSamePlace = 0.1;
  if (trial.fine.part < 0) return "no hypothesis could be compared with the scan";
  const double degrees = trial.fine.rotation_rad * 180.0 / std::numbers::pi;
  if (trial.visible < kLittle) {
    return fmt::format("of the nearest part only {:.0f} % are visible", 100.0 * trial.visible);
  }
  if (trial.fine.center < kSamePlace) {
    return fmt::format(
        "the place is right, but the part is turned by {:.0f} degrees: what is visible "
        "looks alike",
        degrees);
  }
  return fmt::format("the pose lies across several parts, {:.0f} % of the diagonal off the nearest",
                     100.0 * trial.fine.center);
}

void FailurePictures::add(const PaperSetting& setting,
                          const std::string& model,
                          const Mesh& mesh,
                          const Trial& trial,
                          const BinScan& scan,
                          const TrialAnswer& answer) {
  if (trial.fine.right) return;
  const std::string name = fmt::format("{}_{}_{}_{}_bin{}_trial{}.png",
                                       setting.sampling,
                                       setting.size,
                                       setting.views,
                                       model,
                                       trial.bin,
                                       trial.number + 1);
  std::vector<debug::OverlayPose> poses;
  if (answer.fine) {
    poses.push_back({&mesh, *answer.fine, answer.score, "estimate"});
    poses.push_back({&mesh, scan.truth[static_cast<std::size_t>(trial.fine.part)], 1.0, "truth"});
  }
  debug::writeOverlay(folder_ / name, scan.image, poses);
  captions_.push_back(
      fmt::format("- ![{0}]({0}) {1}, bin {2}, part {3} of {4}: {5}; score {6:.2f}.\n",
                  name,
                  model,
                  trial.bin,
                  trial.number + 1,
                  trial.number + static_cast<int>(scan.parts.size()),
                  likelyCause(trial),
                  trial.score));
}

std::string FailurePictures::markdown() const {
  std::string text = fmt::format("{} failed trials\n\n", captions_.size());
  for (const std::string& caption : captions_) text += caption;
  return text;
}

}  // namespace rangepose
