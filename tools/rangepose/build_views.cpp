#include "rangepose/build_views.h"

#include <fmt/format.h>

#include <chrono>
#include <iostream>
#include <optional>
#include <string_view>

#include "core/error.h"
#include "debug/canvas.h"
#include "debug/statistics_pictures.h"
#include "io/atomic_file.h"
#include "io/mesh_file.h"
#include "rangepose/console.h"
#include "rangepose/progress.h"
#include "sampling/drop_statistics.h"
#include "sampling/pose_statistics.h"
#include "sampling/view_sampling.h"

namespace rangepose::cli {
namespace {

namespace fs = std::filesystem;

struct Statistics {
  PoseStatistics poses;
  std::string origin;
};

std::optional<PoseStatistics> usableStatistics(const fs::path& file,
                                               const ViewRequest& request,
                                               std::uint64_t mesh_hash) {
  std::error_code failure;
  if (!fs::exists(file, failure)) return std::nullopt;
  try {
    PoseStatistics statistics = readStatistics(file);
    if (statistics.mesh_hash != mesh_hash) {
      printWarning(file.string() + ": made for another mesh, or in another unit; not used");
      return std::nullopt;
    }
    if (request.bins != 0 && request.bins != statistics.bins) return std::nullopt;
    return statistics;
  } catch (const Error& error) {
    printWarning(std::string(error.what()) + "; not used");
    return std::nullopt;
  }
}

Statistics simulate(const fs::path& file, const ViewRequest& request, const Mesh& mesh) {
  DropStatisticsOptions options;
  if (request.bins != 0) options.bins = request.bins;
  const auto begin = std::chrono::steady_clock::now();
  Statistics result;
  {
    Progress progress(std::cerr, mesh.name + ": bins simulated", options.bins, terminalProgress());
    result.poses =
        simulateStatistics(mesh, options, [&progress](int done) { progress.update(done); });
  }
  result.poses.mesh_hash = meshHash(mesh);
  const std::vector<char> bytes = serialize(result.poses);
  writeFileAtomically(file, std::string_view(bytes.data(), bytes.size()));
  // As the next build will read them, so that it chooses the same views.
  result.poses = deserializeStatistics(bytes, file.string());
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
  result.origin = fmt::format(
      "simulated in {:.0f} s, kept in {} for the next time", seconds.count(), file.string());
  return result;
}

Statistics statisticsOf(const ViewRequest& request, const fs::path& mesh_file, const Mesh& mesh) {
  fs::path beside_mesh = mesh_file;
  beside_mesh.replace_extension(".poses");
  const fs::path beside_database = request.folder / beside_mesh.filename();
  const std::uint64_t hash = meshHash(mesh);
  for (const fs::path& file : {beside_mesh, beside_database}) {
    if (std::optional<PoseStatistics> found = usableStatistics(file, request, hash)) {
      return {std::move(*found), "from " + file.string()};
    }
    if (beside_database == beside_mesh) break;
  }
  return simulate(beside_database, request, mesh);
}

void drawStatistics(const ViewRequest& request,
                    const std::string& note,
                    const Mesh& mesh,
                    const std::vector<glm::dmat3>& resting,
                    const std::vector<glm::dmat3>& views) {
  const fs::path file = request.picture_dir / (mesh.name + "_poses.png");
  debug::writePng(file, debug::statisticsPage(mesh.name, note, resting, views));
}

}  // namespace

ChosenViews chooseViews(const ViewRequest& request,
                        const fs::path& mesh_file,
                        const Mesh& mesh,
                        const Symmetries& symmetries) {
  if (!request.adaptive) return {uniformViews(symmetries, request.views), ""};
  const Statistics statistics = statisticsOf(request, mesh_file, mesh);
  const PoseStatistics& poses = statistics.poses;
  AdaptiveOptions options;
  options.views = request.views;
  ChosenViews chosen{adaptiveViews(symmetries, poses.rotations, options), ""};
  const std::string bins = fmt::format("{} parts in {} bins", poses.parts, poses.bins);
  chosen.note = fmt::format("{}: {}, {}", mesh.name, bins, statistics.origin);
  if (!request.picture_dir.empty()) {
    drawStatistics(request, bins, mesh, poses.rotations, chosen.rotations);
  }
  return chosen;
}

}  // namespace rangepose::cli
