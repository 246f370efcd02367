#include <numeric>
#include <vector>

#include "stages/channels_host.h"

namespace rangepose::host {
namespace {

/// Union-find whose root is always the smallest index of its set.
class Components {
 public:
  explicit Components(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }

  int root(int index) {
    while (at(index) != index) {
      at(index) = at(at(index));
      index = at(index);
    }
    return index;
  }
  void join(int a, int b) {
    a = root(a);
    b = root(b);
    if (a < b) {
      at(b) = a;
    } else {
      at(a) = b;
    }
  }

 private:
  int& at(int index) { return parent_[static_cast<std::size_t>(index)]; }
  std::vector<int> parent_;
};

}  // namespace

Image<std::int32_t> patches(const Image<float>& range_px, const Image<float>& edges) {
  const int width = range_px.width();
  const int height = range_px.height();
  const auto inside = [&](int x, int y) {
    return range_px.at(x, y) != 0.0f && edges.at(x, y) == 0.0f;
  };
  Components components(range_px.size());
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      if (!inside(x, y)) continue;
      const int index = y * width + x;
      if (x > 0 && inside(x - 1, y)) components.join(index, index - 1);
      if (y > 0 && inside(x, y - 1)) components.join(index, index - width);
    }
  }
  Image<std::int32_t> labels(width, height, kNoPatch);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      if (inside(x, y)) labels.at(x, y) = components.root(y * width + x);
    }
  }
  return labels;
}

}  // namespace rangepose::host
