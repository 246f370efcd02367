#include "io/cloud_file.h"

#include "core/error.h"
#include "io/file_bytes.h"
#include "io/pcd_file.h"
#include "io/ply_file.h"

namespace rangepose {
namespace {

constexpr std::uintmax_t kMaxCloudBytes = std::uintmax_t{4} << 30;

PointCloud scaled(const std::vector<glm::dvec3>& points, int width, int height, double scale) {
  PointCloud cloud;
  cloud.points_mm.reserve(points.size());
  for (const glm::dvec3& point : points) cloud.points_mm.emplace_back(point * scale);
  cloud.width = width;
  cloud.height = height;
  return cloud;
}

}  // namespace

PointCloud readCloud(const std::filesystem::path& path, LengthUnit unit) {
  const std::string where = fileLabel("cloud", path);
  const std::string bytes = readFileBytes(path, "cloud", kMaxCloudBytes);
  const double scale = millimetresPer(unit);
  if (bytes.starts_with("ply")) {
    const PlyVertices ply = parsePlyVertices(bytes, where);
    if (ply.points.empty()) throw Error(where + ": the PLY has no points; give a scan");
    const bool organised = ply.grid_height > 1;
    return scaled(ply.points,
                  organised ? ply.grid_width : static_cast<int>(ply.points.size()),
                  organised ? ply.grid_height : 1,
                  scale);
  }
  if (looksLikePcd(bytes)) {
    const PcdPoints pcd = parsePcd(bytes, where);
    return scaled(pcd.points, pcd.width, pcd.height, scale);
  }
  throw Error(where + ": neither PLY nor PCD; give a point cloud");
}

}  // namespace rangepose
