// Awkward range images: random surfaces with holes, empty ones, tiny ones.
#pragma once

#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "core/image.h"

namespace rangepose::test {

struct RangeScene {
  std::string name;
  Image<float> range_px;
};

/// The same numbers with every standard library, unlike its distributions.
class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double uniform(double low, double high) {
    return low + (high - low) * (static_cast<double>(engine_()) / 4294967296.0);
  }
  int index(int count) { return static_cast<int>(engine_() % static_cast<std::uint32_t>(count)); }

 private:
  std::mt19937 engine_;
};

/// Tilted discs at random depths, the nearest on top, with some pixels missing.
inline Image<float> randomBlobs(int width, int height, unsigned seed) {
  Random random(seed);
  Image<float> range(width, height);
  const int blobs = 3 + width * height / 300;
  for (int blob = 0; blob < blobs; ++blob) {
    const double x0 = random.uniform(0, width);
    const double y0 = random.uniform(0, height);
    const double radius = random.uniform(1.0, 14.0);
    const double depth = random.uniform(60.0, 140.0);
    const double slope_x = random.uniform(-1.5, 1.5);
    const double slope_y = random.uniform(-1.5, 1.5);
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        if (std::hypot(x - x0, y - y0) > radius) continue;
        const float z = static_cast<float>(depth + slope_x * (x - x0) + slope_y * (y - y0));
        float& nearest = range.at(x, y);
        if (nearest == 0.0f || z < nearest) nearest = z;
      }
    }
  }
  for (int i = 0; i < width * height / 40; ++i)
    range.at(random.index(width), random.index(height)) = 0.0f;
  return range;
}

/// A corridor that winds through the whole image: labels have the longest way to go.
inline Image<float> spiral(int size) {
  Image<float> range(size, size);
  int x = 0;
  int y = 0;
  int dx = 1;
  int dy = 0;
  const auto blocked = [&](int to_x, int to_y) {
    if (!range.contains(to_x, to_y)) return true;
    return range.contains(to_x + dx, to_y + dy) && range.at(to_x + dx, to_y + dy) != 0.0f;
  };
  for (int turns = 0; turns < 2;) {
    range.at(x, y) = 100.0f;
    if (blocked(x + dx, y + dy)) {
      const int old_dx = dx;
      dx = -dy;
      dy = old_dx;
      ++turns;
      continue;
    }
    turns = 0;
    x += dx;
    y += dy;
  }
  return range;
}

inline std::vector<RangeScene> awkwardScenes() {
  std::vector<RangeScene> scenes;
  for (unsigned seed = 1; seed <= 3; ++seed) {
    const std::string which = " seed " + std::to_string(seed);
    scenes.push_back({"blobs 64x64" + which, randomBlobs(64, 64, seed)});
    scenes.push_back({"blobs 33x17" + which, randomBlobs(33, 17, seed)});
    scenes.push_back({"blobs 128x128" + which, randomBlobs(128, 128, seed)});
  }
  scenes.push_back({"all background", Image<float>(64, 64, 0.0f)});
  scenes.push_back({"all foreground", Image<float>(33, 17, 80.0f)});
  Image<float> one_spike(64, 64, 80.0f);
  one_spike.at(20, 41) = 200.0f;
  scenes.push_back({"one spike", one_spike});
  scenes.push_back({"spiral", spiral(49)});
  scenes.push_back({"one pixel", Image<float>(1, 1, 5.0f)});
  scenes.push_back({"one row", randomBlobs(19, 1, 4)});
  scenes.push_back({"one column", randomBlobs(1, 23, 5)});
  return scenes;
}

}  // namespace rangepose::test
