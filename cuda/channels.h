// The image stages on the device (paper Sect. 5): contracts in src/stages/channels_host.h and
// resample_host.h. Results equal the host's bit for bit. Nothing waits, nothing is allocated:
// results and scratch are passed in. Images hold float unless said otherwise.
#pragma once

#include <cuda_runtime_api.h>

#include <cstdint>

#include "core/image.h"
#include "cuda/image_view.h"
#include "stages/resample_core.h"

namespace rangepose::cuda {

/// A depth image on the device, row by row.
struct DepthPixels {
  const float* depth_mm = nullptr;     ///< 0: not measured
  const std::uint8_t* keep = nullptr;  ///< 0: left out (background); nullptr: nothing is
  int width = 0;                       ///< [px]
  int height = 0;                      ///< [px]
};

/// Only pixels of `region` are read. `scratch`: range_px.width * range_px.height numbers.
void resample(const DepthPixels& depth,
              const ResampleSetup& setup,
              const PixelBox& region,
              unsigned int* scratch,
              ImageView range_px,
              cudaStream_t stream);

void median(ImageView range, ImageView result, cudaStream_t stream);

void edges(ImageView range_px, float threshold_px, ImageView result, cudaStream_t stream);

/// Two images of EdtTexel (float4), as large as the others.
struct EdtScratch {
  ImageView even;
  ImageView odd;
};

/// One launch a pass, as in the paper. The texels after the last pass are in the view returned.
ImageView distanceTexels(ImageView range_px,
                         ImageView edges,
                         int passes,
                         const EdtScratch& scratch,
                         cudaStream_t stream);

/// All passes of a tile in one launch, where they fit into shared memory (16); `scratch` is used
/// beyond that.
void distance(ImageView range_px,
              ImageView edges,
              int passes,
              const EdtScratch& scratch,
              ImageView result,
              cudaStream_t stream);

/// `labels`: width * height numbers, row by row.
void patches(ImageView range_px, ImageView edges, std::int32_t* labels, cudaStream_t stream);

}  // namespace rangepose::cuda
