#include "stages/reference.h"

#include <algorithm>
#include <atomic>

namespace rangepose {

double ReferenceObject::meanArea() const {
  double sum = 0.0;
  for (const ReferenceView& view : views) sum += static_cast<double>(view.area_px);
  return views.empty() ? 0.0 : sum / static_cast<double>(views.size());
}

float ReferenceObject::maxArea() const {
  float area = 0.0f;
  for (const ReferenceView& view : views) area = std::max(area, view.area_px);
  return area;
}

std::uint64_t newReferenceSerial() {
  static std::atomic<std::uint64_t> last{0};
  return ++last;
}

int atlasColumns(int views) {
  int columns = 1;
  while (columns * columns < views) ++columns;
  return columns;
}

}  // namespace rangepose
