// The foreground of a depth image and what it is found by.
#pragma once

#include "stages/foreground.h"

namespace rangepose::host {

/// Noise, lost pixels, background and mask in one.
Foreground foreground(const DepthImage& measured, const ForegroundTask& task);

/// Large planes with nearly nothing behind them: a table or floor, then walls that stand on it.
/// Repeatable: the random numbers are seeded.
std::vector<BackgroundPlane> findBackground(const DepthImage& image,
                                            const ForegroundOptions& options);

/// 1 where a pixel was measured and lies in front of all planes by more than the tolerance and, if
/// a box is given, inside of the bin (or above it); else 0.
Image<std::uint8_t> foregroundMask(const DepthImage& image,
                                   const std::vector<BackgroundPlane>& planes,
                                   const std::optional<BinBox>& bin,
                                   const ForegroundOptions& options);

/// Of all measured pixels of the mask; an empty mask leaves nothing out.
LateralExtent extentOf(const DepthImage& image, const Image<std::uint8_t>& mask);

}  // namespace rangepose::host
