#include "eval/known_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.h"
#include "stages/surface.h"

namespace rangepose {
namespace {

/// A step of depth between neighbouring pixels that goes on in neither's plane by more than this
/// is a jump: share of the diameter, and [mm].
constexpr double kJumpShare = 0.02;
constexpr double kJumpMm = 2.0;

constexpr double kAgreeShare = 0.04;
constexpr double kAgreeMm = 4.0;

void draw(const KnownPart& part, int index, const Camera& camera, KnownSurface& known) {
  const Sphere sphere = boundingSphere(*part.mesh);
  const SurfaceWindow window = windowAround(camera,
                                            part.camera_from_object * sphere.center_mm,
                                            sphere.radius_mm,
                                            std::max(camera.width, camera.height));
  if (window.width == 0) return;
  const Image<SurfaceTexel> surface =
      host::renderSurface(*part.mesh, camera, part.camera_from_object, window);
  for (int y = 0; y < window.height; ++y) {
    for (int x = 0; x < window.width; ++x) {
      const SurfaceTexel& texel = surface.at(x, y);
      KnownPixel& pixel = known.at(window.x0 + x, window.y0 + y);
      if (texel.w <= 0.0f || (pixel.part >= 0 && pixel.depth_mm <= texel.w)) continue;
      const glm::dvec3 normal(texel);
      const glm::dvec3 ray = glm::normalize(rayOf(camera, window.x0 + x, window.y0 + y));
      const double cosine = std::clamp(-glm::dot(normal, ray), 0.0, 1.0);
      pixel = {index, texel.w, glm::vec3(normal), static_cast<float>(cosine), 0};
    }
  }
}

/// How far the depth at (u, v) is from the plane of another pixel there [mm].
double offPlane(
    const KnownSurface& known, const Camera& camera, int from_u, int from_v, int u, int v) {
  const KnownPixel& from = known.at(from_u, from_v);
  const glm::dvec3 normal(from.normal);
  const double facing = glm::dot(normal, rayOf(camera, u, v));
  if (!(facing < 0.0)) return std::numeric_limits<double>::infinity();
  const glm::dvec3 point = camera.unproject(from_u, from_v, from.depth_mm);
  const double depth = glm::dot(normal, point - camera.unproject(u, v, 0.0)) / facing;
  return std::abs(depth - known.at(u, v).depth_mm);
}

bool sameSurface(const KnownSurface& known,
                 const std::vector<KnownPart>& parts,
                 const Camera& camera,
                 const glm::ivec2& a,
                 const glm::ivec2& b) {
  const int part = known.at(a.x, a.y).part;
  if (part != known.at(b.x, b.y).part) return false;
  const double jump =
      std::max(kJumpMm, kJumpShare * parts[static_cast<std::size_t>(part)].diameter_mm);
  return std::min(offPlane(known, camera, a.x, a.y, b.x, b.y),
                  offPlane(known, camera, b.x, b.y, a.x, a.y)) <= jump;
}

/// Pixels of parts with a neighbour of the eight that is not on the same surface.
Image<char> borders(const KnownSurface& known,
                    const std::vector<KnownPart>& parts,
                    const Camera& camera) {
  Image<char> border(known.width(), known.height(), 0);
  for (int v = 0; v < known.height(); ++v) {
    for (int u = 0; u < known.width(); ++u) {
      if (known.at(u, v).part < 0) continue;
      for (int k = 0; k < 9 && border.at(u, v) == 0; ++k) {
        const glm::ivec2 near(u + k % 3 - 1, v + k / 3 - 1);
        if (k == 4 || !known.contains(near.x, near.y)) continue;
        border.at(u, v) = sameSurface(known, parts, camera, {u, v}, near) ? 0 : 1;
      }
    }
  }
  return border;
}

/// Distances to the nearest border, as KnownPixel::inside_px: one sweep forward, one back.
void fillInside(const Image<char>& border, KnownSurface& known) {
  const int width = known.width();
  const int height = known.height();
  const auto shorten = [&](int u, int v, int sign) {
    int& inside = known.at(u, v).inside_px;
    for (const glm::ivec2& step : {glm::ivec2(-1, -1), {0, -1}, {1, -1}, {-1, 0}}) {
      const glm::ivec2 near = glm::ivec2(u, v) + sign * step;
      if (known.contains(near.x, near.y)) {
        inside = std::min(inside, known.at(near.x, near.y).inside_px + 1);
      }
    }
  };
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      known.at(u, v).inside_px = border.at(u, v) != 0 ? 0 : width + height;
      shorten(u, v, 1);
    }
  }
  for (int v = height - 1; v >= 0; --v) {
    for (int u = width - 1; u >= 0; --u) shorten(u, v, -1);
  }
}

}  // namespace

double agreementMm(const KnownPart& part) {
  return std::max(kAgreeMm, kAgreeShare * part.diameter_mm);
}

glm::dvec3 rayOf(const Camera& camera, int u, int v) {
  return camera.unproject(u, v, 1.0) - camera.unproject(u, v, 0.0);
}

KnownSurface renderKnown(const std::vector<KnownPart>& parts, const Camera& camera) {
  KnownSurface known(camera.width, camera.height);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    draw(parts[i], static_cast<int>(i), camera, known);
  }
  fillInside(borders(known, parts, camera), known);
  return known;
}

}  // namespace rangepose
