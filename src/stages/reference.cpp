#include "stages/reference.h"

#include <algorithm>

namespace rangepose {

float ReferenceObject::maxArea() const {
  float area = 0.0f;
  for (const ReferenceView& view : views) area = std::max(area, view.area_px);
  return area;
}

int atlasColumns(int views) {
  int columns = 1;
  while (columns * columns < views) ++columns;
  return columns;
}

}  // namespace rangepose
