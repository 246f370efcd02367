// Pixel grouping by union-find (paper Sect. 5.3). Differs from the paper: instead of passes until
// nothing changes, every pixel joins its neighbours once. A root is the smallest
// index of its set, so the labels do not depend on the order in which threads come.
#pragma once

#include "cuda/block.h"
#include "stages/scene_channels.h"

namespace rangepose::cuda {

/// Labels start as runs of pixels in a row, cut at multiples of this: that saves most of the joins.
inline constexpr int kPatchRun = 32;

/// `inside(x, y)` says whether a pixel is of a surface and no edge.
template <typename Inside>
RP_BODY int firstLabel(int x, int y, int width, const Inside& inside) {
  if (!inside(x, y)) return kNoPatch;
  int first = x;
  while (first % kPatchRun != 0 && inside(first - 1, y)) --first;
  return y * width + first;
}

/// `label(index)` reads a label as it is now.
template <typename Label>
RP_BODY int rootOf(int index, const Label& label) {
  for (int parent = label(index); parent != index; parent = label(index)) index = parent;
  return index;
}

/// `lower(index, value)` makes a label at most `value` at once, and gives what it was before.
template <typename Label, typename Lower>
RP_BODY void joinPatches(int a, int b, const Label& label, const Lower& lower) {
  for (;;) {
    a = rootOf(a, label);
    b = rootOf(b, label);
    if (a == b) return;
    const int low = a < b ? a : b;
    const int high = a < b ? b : a;
    const int before = lower(high, low);
    if (before == high) return;
    // Another thread was faster: `high` is no root any more, and what it points to must join too.
    a = low;
    b = before;
  }
}

/// Joins pixel (x, y) to its left and its upper neighbour.
template <typename Label, typename Lower>
RP_BODY void joinNeighbours(int x, int y, int width, const Label& label, const Lower& lower) {
  const int index = y * width + x;
  if (label(index) == kNoPatch) return;
  const bool left = x > 0 && label(index - 1) != kNoPatch;
  if (left && x % kPatchRun == 0) joinPatches(index, index - 1, label, lower);
  if (y == 0 || label(index - width) == kNoPatch) return;
  // The left neighbour has joined the row above already.
  if (left && label(index - width - 1) != kNoPatch) return;
  joinPatches(index, index - width, label, lower);
}

}  // namespace rangepose::cuda
