#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <map>
#include <utility>

#include "core/error.h"
#include "io/atomic_file.h"
#include "io/bop.h"

namespace rangepose {
namespace {

std::string number(double value, const BopEstimate& row) {
  if (!std::isfinite(value)) {
    throw Error(fmt::format("BOP result of scene {} image {} object {}: a value is not finite",
                            row.scene_id,
                            row.im_id,
                            row.obj_id));
  }
  return fmt::format("{:.9g}", value + 0.0);  // + 0.0: no "-0"
}

}  // namespace

std::string bopCsv(const std::vector<BopEstimate>& estimates) {
  std::string text = "scene_id,im_id,obj_id,score,R,t,time\n";
  std::map<std::pair<int, int>, double> time_of_image;
  for (const BopEstimate& row : estimates) {
    const auto [known, is_new] = time_of_image.try_emplace({row.scene_id, row.im_id}, row.time_s);
    if (!is_new && known->second != row.time_s) {
      throw Error(fmt::format(
          "BOP results of scene {} image {}: rows with different times", row.scene_id, row.im_id));
    }
    fmt::format_to(std::back_inserter(text),
                   "{},{},{},{},",
                   row.scene_id,
                   row.im_id,
                   row.obj_id,
                   number(row.score, row));
    const Pose& pose = row.camera_from_object;
    for (int i = 0; i < 9; ++i) {
      text += number(pose.rotation[i % 3][i / 3], row);
      text += i < 8 ? ' ' : ',';
    }
    for (int i = 0; i < 3; ++i) {
      text += number(pose.translation_mm[i], row);
      text += i < 2 ? ' ' : ',';
    }
    text += number(row.time_s, row) + "\n";
  }
  return text;
}

void writeBopCsv(const std::filesystem::path& path, const std::vector<BopEstimate>& estimates) {
  writeFileAtomically(path, bopCsv(estimates));
}

}  // namespace rangepose
