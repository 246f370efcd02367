#include "peers/scene_cloud.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include "core/parallel.h"

namespace rangepose::peers {
namespace {

/// Least squares of value = a * u + b * v + c over pixels.
class PlaneFit {
 public:
  void add(double u, double v, double value) {
    const glm::dvec3 row(u, v, 1.0);
    matrix_ += glm::outerProduct(row, row);
    right_ += row * value;
    ++count_;
  }
  int count() const { return count_; }
  std::optional<glm::dvec3> solve() const {
    const double determinant = glm::determinant(matrix_);
    if (!(std::abs(determinant) > 1e-6)) return std::nullopt;
    return glm::inverse(matrix_) * right_;
  }

 private:
  glm::dmat3 matrix_{0.0};
  glm::dvec3 right_{0.0};
  int count_ = 0;
};

/// What is linear in (u, v) on a plane: 1 / z, or z of an orthographic camera.
double linearValue(const Camera& camera, double z_mm) {
  return camera.orthographic ? z_mm : 1.0 / z_mm;
}

/// The normal of the plane value = a * (u - u0) + b * (v - v0) + c, towards the camera.
glm::dvec3 planeNormal(const Camera& camera, int u0, int v0, const glm::dvec3& abc) {
  if (camera.orthographic) return glm::normalize(glm::dvec3(abc.x, abc.y, -camera.pixel_size_mm));
  // The plane's points p have dot(away, p) = 1, so that it looks away from the camera.
  const glm::dvec3 away(abc.x * camera.fx,
                        abc.y * camera.fy,
                        abc.z + abc.x * (camera.cx - u0) + abc.y * (camera.cy - v0));
  return -glm::normalize(away);
}

std::optional<glm::dvec3> normalAt(const DepthImage& image, int u, int v, int reach) {
  const double here = static_cast<double>(image.depth_mm.at(u, v));
  // Steeper than about 75 degrees between neighbours is taken for a jump.
  const double gap_mm = 4.0 * image.camera.pixelSpacingMm(here);
  PlaneFit fit;
  for (int dv = -reach; dv <= reach; ++dv) {
    for (int du = -reach; du <= reach; ++du) {
      if (!image.depth_mm.contains(u + du, v + dv)) continue;
      const double z = static_cast<double>(image.depth_mm.at(u + du, v + dv));
      const double limit = gap_mm * std::max({std::abs(du), std::abs(dv), 1});
      if (z > 0.0 && std::abs(z - here) < limit) fit.add(du, dv, linearValue(image.camera, z));
    }
  }
  const int side = 2 * reach + 1;
  if (2 * fit.count() < side * side) return std::nullopt;
  const std::optional<glm::dvec3> abc = fit.solve();
  if (!abc) return std::nullopt;
  return planeNormal(image.camera, u, v, *abc);
}

/// Cube and the main direction of the normal: both sides of a thin wall stay apart.
std::array<int, 4> cellOf(const SurfacePoint& point, double cell_mm) {
  std::array<int, 4> cell{};
  int axis = 0;
  for (int k = 0; k < 3; ++k) {
    const double share = static_cast<double>(point.position_mm[k]) / cell_mm;
    cell[static_cast<std::size_t>(k)] = static_cast<int>(std::floor(share));
    if (std::abs(point.normal[k]) > std::abs(point.normal[axis])) axis = k;
  }
  cell[3] = 2 * axis + (point.normal[axis] > 0.0f ? 1 : 0);
  return cell;
}

}  // namespace

Cloud cloudOf(const DepthImage& image, const Image<std::uint8_t>& keep, int reach) {
  constexpr int kRows = 16;
  std::vector<Cloud> rows(static_cast<std::size_t>(image.depth_mm.height()));
  parallelFor(image.depth_mm.height(), kRows, [&](int begin, int end) {
    for (int v = begin; v < end; ++v) {
      for (int u = 0; u < image.depth_mm.width(); ++u) {
        const double z = static_cast<double>(image.depth_mm.at(u, v));
        if (keep.at(u, v) == 0 || !(z > 0.0)) continue;
        const std::optional<glm::dvec3> normal = normalAt(image, u, v, reach);
        if (!normal) continue;
        rows[static_cast<std::size_t>(v)].push_back(
            {glm::vec3(image.camera.unproject(u, v, z)), glm::vec3(*normal)});
      }
    }
  });
  Cloud cloud;
  for (const Cloud& row : rows) cloud.insert(cloud.end(), row.begin(), row.end());
  return cloud;
}

Cloud thinned(const Cloud& cloud, double cell_mm) {
  struct Sum {
    glm::vec3 position{0.0f};
    glm::vec3 normal{0.0f};
    float count = 0.0f;
  };
  std::map<std::array<int, 4>, Sum> cells;
  for (const SurfacePoint& point : cloud) {
    Sum& sum = cells[cellOf(point, cell_mm)];
    sum.position += point.position_mm;
    sum.normal += point.normal;
    sum.count += 1.0f;
  }
  Cloud result;
  result.reserve(cells.size());
  for (const auto& [cell, sum] : cells) {
    result.push_back({sum.position / sum.count, glm::normalize(sum.normal)});
  }
  return result;
}

std::vector<glm::dvec3> spreadSeeds(const Cloud& cloud, double apart_mm, int most) {
  std::vector<glm::dvec3> seeds;
  if (cloud.empty()) return seeds;
  std::vector<double> distance(cloud.size(), std::numeric_limits<double>::max());
  const auto nearest =
      std::min_element(cloud.begin(), cloud.end(), [](const auto& a, const auto& b) {
        return a.position_mm.z < b.position_mm.z;
      });
  std::size_t next = static_cast<std::size_t>(nearest - cloud.begin());
  while (static_cast<int>(seeds.size()) < most && distance[next] >= apart_mm) {
    seeds.emplace_back(cloud[next].position_mm);
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      distance[i] =
          std::min(distance[i], glm::distance(seeds.back(), glm::dvec3(cloud[i].position_mm)));
    }
    next = static_cast<std::size_t>(std::max_element(distance.begin(), distance.end()) -
                                    distance.begin());
  }
  return seeds;
}

Cloud cropped(const Cloud& cloud, const glm::dvec3& center_mm, double radius_mm) {
  Cloud result;
  std::copy_if(cloud.begin(), cloud.end(), std::back_inserter(result), [&](const auto& point) {
    return glm::distance(glm::dvec3(point.position_mm), center_mm) <= radius_mm;
  });
  return result;
}

}  // namespace rangepose::peers
