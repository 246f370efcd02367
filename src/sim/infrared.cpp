#include "sim/infrared.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "sim/random.h"

namespace rangepose {
namespace {

constexpr int kTexelsPerPixel = 2;  // of the pattern

double lengthSquared(const glm::dvec3& v) { return glm::dot(v, v); }

/// Adds a Gaussian spot; `sigma` in texels.
void addDot(Image<float>& texels, double x, double y, double sigma, double brightness) {
  const int reach = static_cast<int>(std::ceil(3.0 * sigma));
  const int x0 = static_cast<int>(std::lround(x));
  const int y0 = static_cast<int>(std::lround(y));
  for (int j = y0 - reach; j <= y0 + reach; ++j) {
    for (int i = x0 - reach; i <= x0 + reach; ++i) {
      if (!texels.contains(i, j)) continue;
      const double away = (i - x) * (i - x) + (j - y) * (j - y);
      texels.at(i, j) += static_cast<float>(brightness * std::exp(-0.5 * away / (sigma * sigma)));
    }
  }
}

std::vector<float> gaussianKernel(double deviation_px) {
  const int reach = std::max(1, static_cast<int>(std::ceil(3.0 * deviation_px)));
  std::vector<float> kernel;
  double sum = 0.0;
  for (int i = -reach; i <= reach; ++i) {
    kernel.push_back(static_cast<float>(std::exp(-0.5 * i * i / (deviation_px * deviation_px))));
    sum += kernel.back();
  }
  for (float& weight : kernel) weight = static_cast<float>(weight / sum);
  return kernel;
}

/// What a point sends to the eye of the light that reaches it, without distance and pattern.
double reflected(const Reflectance& surface,
                 const glm::dvec3& normal,
                 const glm::dvec3& to_light,
                 const glm::dvec3& to_eye) {
  const double facing = glm::dot(normal, to_light);
  if (facing <= 0.0) return 0.0;
  if (surface.gloss == 0.0) return surface.diffuse * facing;
  const glm::dvec3 half = glm::normalize(to_light + to_eye);
  const double mirror = std::max(0.0, glm::dot(normal, half));
  return surface.diffuse * facing + surface.gloss * std::pow(mirror, surface.exponent);
}

/// Ways of light in a scene are compared with this [mm].
constexpr double kUnitWayMm = 1000.0;

/// Brightness of one pixel before the lens blurs it.
double brightnessAt(const Viewpoint& from,
                    const Illumination& light,
                    const std::vector<Reflectance>& reflectances,
                    int u,
                    int v) {
  const SurfaceTexel& texel = from.view.surface.at(u, v);
  if (texel.w == 0.0f || from.view.shiny.at(u, v) != 0) return 0.0;
  const int part = from.view.part.at(u, v);
  const Reflectance& surface =
      part < 0 ? reflectances.back() : reflectances[static_cast<std::size_t>(part)];
  const glm::dvec3 seen = from.view.camera.unproject(u, v, texel.w);
  const glm::dvec3 normal(texel);
  const glm::dvec3 to_eye = -glm::normalize(seen);
  // The light of the room comes from all sides, the more from where the camera is.
  double brightness = light.ambient * reflected(surface, normal, to_eye, to_eye);
  const ProjectorView& projector = *light.projector;
  const glm::dvec3 from_light = seen + from.position_mm - projector.position_mm;
  if (isLit(projector, from_light)) {
    const glm::dvec2 pixel = from.view.camera.project(from_light);
    const double way = lengthSquared(from_light) / (kUnitWayMm * kUnitWayMm);
    brightness += light.dots->at(pixel.x, pixel.y) *
                  reflected(surface, normal, -glm::normalize(from_light), to_eye) / way;
  }
  return brightness;
}

}  // namespace

std::vector<Reflectance> drawReflectances(std::size_t parts, std::uint64_t seed) {
  // Machined, cast and painted parts: dull to glossy.
  constexpr double kDarkest = 0.35;
  constexpr double kBrightest = 0.9;
  constexpr double kGlossiest = 0.35;
  Random random(seed);
  std::vector<Reflectance> all(parts + 1);
  for (Reflectance& one : all) {
    one.diffuse = random.uniform(kDarkest, kBrightest);
    one.gloss = kGlossiest * random.uniform();
    one.exponent = random.uniform(10.0, 60.0);
  }
  all.back() = {0.6, 0.0, 1.0};
  return all;
}

DotPattern::DotPattern(const Camera& camera, const MatchingSensor& sensor) {
  constexpr std::uint64_t kDevice = 1;  // all devices of a kind have the same pattern here
  const double scale = kTexelsPerPixel;
  margin_px_ = camera.width / 2;
  texels_ = Image<float>((camera.width + 2 * margin_px_) * kTexelsPerPixel,
                         camera.height * kTexelsPerPixel);
  const double cell = sensor.dot_spacing_px * scale;
  const double sigma = sensor.dot_px * scale;
  Random random(kDevice);
  for (double y = 0.0; y < texels_.height(); y += cell) {
    for (double x = 0.0; x < texels_.width(); x += cell) {
      const double at_x = x + cell * random.uniform();
      const double at_y = y + cell * random.uniform();
      addDot(texels_, at_x, at_y, sigma, random.uniform(0.5, 1.0));
    }
  }
}

double DotPattern::at(double u, double v) const {
  const double x = std::clamp((u + margin_px_ + 0.5) * kTexelsPerPixel - 0.5,
                              0.0,
                              static_cast<double>(texels_.width() - 2));
  const double y =
      std::clamp((v + 0.5) * kTexelsPerPixel - 0.5, 0.0, static_cast<double>(texels_.height() - 2));
  const int i = static_cast<int>(x);
  const int j = static_cast<int>(y);
  const double a = x - i;
  const double b = y - j;
  return (1.0 - b) * ((1.0 - a) * texels_.at(i, j) + a * texels_.at(i + 1, j)) +
         b * ((1.0 - a) * texels_.at(i, j + 1) + a * texels_.at(i + 1, j + 1));
}

Image<float> infraredImage(const Viewpoint& from,
                           const Illumination& light,
                           const std::vector<Reflectance>& reflectances,
                           const MatchingSensor& sensor) {
  const Camera& camera = from.view.camera;
  Image<float> brightness(camera.width, camera.height);
  parallelFor(camera.height, 16, [&](int first, int last) {
    for (int v = first; v < last; ++v) {
      for (int u = 0; u < camera.width; ++u) {
        brightness.at(u, v) = static_cast<float>(brightnessAt(from, light, reflectances, u, v));
      }
    }
  });
  return blurred(brightness, sensor.blur_px);
}

Image<std::uint8_t> exposed(const Image<float>& brightness,
                            const MatchingSensor& sensor,
                            std::uint64_t seed) {
  constexpr double kWhite = 255.0;
  constexpr double kWhiteShare = 0.05;
  constexpr double kReadNoise = 0.5;  // of the noise at full exposure, in the dark
  std::vector<float> sorted(brightness.begin(), brightness.end());
  const auto place =
      static_cast<std::ptrdiff_t>((1.0 - kWhiteShare) * static_cast<double>(sorted.size() - 1));
  std::nth_element(sorted.begin(), sorted.begin() + place, sorted.end());
  const double full = std::max(1e-9, static_cast<double>(sorted[static_cast<std::size_t>(place)]));
  Random random(seed);
  Image<std::uint8_t> grey(brightness.width(), brightness.height());
  for (std::size_t i = 0; i < grey.size(); ++i) {
    const double share = brightness.data()[i] / full;
    const double deviation =
        sensor.image_noise *
        std::sqrt(kReadNoise * kReadNoise + (1.0 - kReadNoise * kReadNoise) * std::min(share, 1.0));
    const double value = kWhite * share + deviation * random.normal();
    grey.data()[i] = static_cast<std::uint8_t>(std::clamp(std::round(value), 0.0, kWhite));
  }
  return grey;
}

Image<std::uint8_t> storedPattern(const DotPattern& dots,
                                  const Camera& camera,
                                  const MatchingSensor& sensor) {
  const int beside_px = sensor.least_disparity_px + sensor.disparities;
  Image<float> brightness(camera.width + beside_px, camera.height);
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < brightness.width(); ++u) {
      brightness.at(u, v) = static_cast<float>(sensor.ambient + dots.at(u - beside_px, v));
    }
  }
  MatchingSensor quiet = sensor;  // it is an average of many images
  quiet.image_noise = 0.0;
  return exposed(blurred(brightness, sensor.blur_px), quiet, 0);
}

Image<float> blurred(const Image<float>& image, double deviation_px) {
  if (deviation_px <= 0.0) return image;
  const std::vector<float> kernel = gaussianKernel(deviation_px);
  const int reach = static_cast<int>(kernel.size() / 2);
  const int width = image.width();
  const int height = image.height();
  Image<float> across(width, height);
  Image<float> result(width, height);
  parallelFor(height, 16, [&](int first, int last) {
    for (int v = first; v < last; ++v) {
      for (int u = 0; u < width; ++u) {
        float sum = 0.0f;
        for (int k = -reach; k <= reach; ++k) {
          sum += kernel[static_cast<std::size_t>(k + reach)] *
                 image.at(std::clamp(u + k, 0, width - 1), v);
        }
        across.at(u, v) = sum;
      }
    }
  });
  parallelFor(height, 16, [&](int first, int last) {
    for (int v = first; v < last; ++v) {
      for (int u = 0; u < width; ++u) {
        float sum = 0.0f;
        for (int k = -reach; k <= reach; ++k) {
          sum += kernel[static_cast<std::size_t>(k + reach)] *
                 across.at(u, std::clamp(v + k, 0, height - 1));
        }
        result.at(u, v) = sum;
      }
    }
  });
  return result;
}

}  // namespace rangepose
