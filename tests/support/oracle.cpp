#include "support/oracle.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace rangepose::test::oracle {

Image<float> median(const Image<float>& range) {
  Image<float> result(range.width(), range.height());
  for (int y = 0; y < range.height(); ++y) {
    for (int x = 0; x < range.width(); ++x) {
      std::vector<float> values;
      values.reserve(9);
      for (int i = 0; i < 9; ++i) {
        values.push_back(range.at(std::clamp(x + i % 3 - 1, 0, range.width() - 1),
                                  std::clamp(y + i / 3 - 1, 0, range.height() - 1)));
      }
      std::sort(values.begin(), values.end());
      result.at(x, y) = values[4];
    }
  }
  return result;
}

Image<float> edges(const Image<float>& range, float threshold) {
  // What lies outside is what is nearest to it inside.
  const auto at = [](const auto& image, int x, int y) {
    return image.at(std::clamp(x, 0, image.width() - 1), std::clamp(y, 0, image.height() - 1));
  };
  Image<float> steep(range.width(), range.height(), 0.0f);
  Image<float> jumps(range.width(), range.height(), 0.0f);
  const int across[4][2] = {{1, 0}, {0, 1}, {1, 1}, {1, -1}};
  for (int y = 0; y < range.height(); ++y) {
    for (int x = 0; x < range.width(); ++x) {
      const float here = range.at(x, y);
      for (const auto& [dx, dy] : across) {
        const float to = at(range, x + dx, y + dy) - here;
        const float from = here - at(range, x - dx, y - dy);
        const bool far = std::fabs(to) > threshold || std::fabs(from) > threshold;
        if (here == 0.0f || !far) continue;
        steep.at(x, y) = 1.0f;
        if (std::fabs(to - from) > threshold) jumps.at(x, y) = 1.0f;
      }
    }
  }
  Image<float> result = jumps;
  for (int y = 0; y < range.height(); ++y) {
    for (int x = 0; x < range.width(); ++x) {
      for (int i = 0; i < 9; ++i) {
        const bool beside = at(jumps, x + i % 3 - 1, y + i / 3 - 1) != 0.0f;
        if (steep.at(x, y) != 0.0f && beside) result.at(x, y) = 1.0f;
      }
    }
  }
  return result;
}

Image<double> nearestEdgeSquared(const Image<float>& edges) {
  std::vector<glm::ivec2> sites;
  for (int y = 0; y < edges.height(); ++y) {
    for (int x = 0; x < edges.width(); ++x) {
      if (edges.at(x, y) != 0.0f) sites.emplace_back(x, y);
    }
  }
  Image<double> result(edges.width(), edges.height(), -1.0);
  for (int y = 0; y < edges.height(); ++y) {
    for (int x = 0; x < edges.width(); ++x) {
      int best = -1;
      for (const glm::ivec2& site : sites) {
        const int squared = (site.x - x) * (site.x - x) + (site.y - y) * (site.y - y);
        if (best < 0 || squared < best) best = squared;
      }
      result.at(x, y) = best;
    }
  }
  return result;
}

Image<std::int32_t> patches(const Image<float>& range, const Image<float>& edges) {
  Image<std::int32_t> labels(range.width(), range.height(), kNoPatch);
  const auto fillable = [&](int x, int y) {
    return range.contains(x, y) && range.at(x, y) != 0.0f && edges.at(x, y) == 0.0f &&
           labels.at(x, y) == kNoPatch;
  };
  // In the order of their indices, so that the first pixel of a region has its smallest index.
  for (int start = 0; start < static_cast<int>(range.size()); ++start) {
    std::vector<glm::ivec2> open = {{start % range.width(), start / range.width()}};
    if (!fillable(open[0].x, open[0].y)) continue;
    while (!open.empty()) {
      const glm::ivec2 at = open.back();
      open.pop_back();
      if (!fillable(at.x, at.y)) continue;
      labels.at(at.x, at.y) = start;
      for (const glm::ivec2 step : {glm::ivec2(1, 0), {-1, 0}, {0, 1}, {0, -1}}) {
        open.push_back(at + step);
      }
    }
  }
  return labels;
}

Terms errorTerms(const ReferenceObject& object,
                 int view,
                 const SceneChannels& window,
                 const glm::vec3& translation,
                 const ErrorOptions& options,
                 double background) {
  Terms terms;
  const double reach = 0.75 * object.size;
  if (std::fabs(translation.x) > reach || std::fabs(translation.y) > reach) return terms;
  const glm::ivec2 origin = object.tileOrigin(view);
  const int margin = (window.range_px.width() - object.size) / 2;
  const int shift_x = static_cast<int>(std::floor(translation.x + 0.5f));
  const int shift_y = static_cast<int>(std::floor(translation.y + 0.5f));
  for (int v = 0; v < object.size; v += options.row_step) {
    for (int u = 0; u < object.size; ++u) {
      const ReferenceTexel texel = object.atlas.at(origin.x + u, origin.y + v);
      const int x = u + margin + shift_x;
      const int y = v + margin + shift_y;
      const bool inside = window.range_px.contains(x, y);
      const double seen = inside ? window.range_px.at(x, y) : 0.0;
      const double predicted = static_cast<double>(texel.g) - object.size + translation.z;
      if (texel.r > 0.0f) {  // Eq. 4
        const double there = inside ? window.distance_px.at(x, y) : background;
        terms.cover_sum += std::fabs(there - texel.r);
        terms.cover_count += 1.0;
      }
      if (texel.g == 0.0f) continue;  // Eq. 6: c = 0
      double weight = texel.a;
      const double limit = options.range_limit_px;
      double d = seen != 0.0 ? std::min(limit, std::fabs(seen - predicted)) : 0.0;  // Eq. 5
      if (seen == 0.0 && options.holes == HolePolicy::kIgnore) weight = 0.0;
      if (seen == 0.0 && options.holes == HolePolicy::kLimit) d = limit;
      terms.range_sum += weight * d;
      terms.range_weight += weight;
    }
  }
  return terms;
}

double distanceToTriangle(const glm::dvec3& point, const std::array<glm::dvec3, 3>& corners) {
  const glm::dvec3 cross = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
  double best = std::numeric_limits<double>::infinity();
  bool above = glm::length(cross) > 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    const glm::dvec3 from = corners[i];
    const glm::dvec3 side = corners[(i + 1) % 3] - from;
    const double squared = glm::dot(side, side);
    const double along =
        squared > 0.0 ? std::clamp(glm::dot(point - from, side) / squared, 0.0, 1.0) : 0.0;
    best = std::min(best, glm::distance(point, from + along * side));
    above = above && glm::dot(glm::cross(side, point - from), cross) >= 0.0;
  }
  if (!above) return best;
  return std::min(best, std::fabs(glm::dot(point - corners[0], glm::normalize(cross))));
}

NearestFace nearestFace(const Mesh& mesh, const glm::dvec3& point) {
  NearestFace nearest{std::numeric_limits<double>::infinity(), glm::dvec3(0.0)};
  for (const glm::uvec3& triangle : mesh.triangles) {
    const std::array<glm::dvec3, 3> corners = {glm::dvec3(mesh.vertices[triangle.x]),
                                               glm::dvec3(mesh.vertices[triangle.y]),
                                               glm::dvec3(mesh.vertices[triangle.z])};
    const double distance = distanceToTriangle(point, corners);
    if (distance >= nearest.distance_mm) continue;
    const glm::dvec3 normal = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
    nearest = {distance, glm::normalize(normal)};
  }
  return nearest;
}

}  // namespace rangepose::test::oracle
