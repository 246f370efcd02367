// Launches of the foreground stages: contracts in noise_host.h, dropouts_host.h and
// foreground_host.h of src/stages. Noise and planes are sums in another order than the host's:
// equal to 1e-10 of what they are, and but for a pixel as close as that to a limit the images are
// the same. Nothing waits.
#pragma once

#include <cuda_runtime_api.h>

#include <cstdint>

#include "cuda/foreground_types.h"

namespace rangepose::cuda {

/// Blocks that share the pixels of an image where each reduces what it sees.
inline constexpr int kImageParts = 64;

/// Device memory; images row by row, of the camera's size.
struct ForegroundMemory {
  const float* measured = nullptr;       ///< the image as it came [mm]
  float* depth = nullptr;                ///< with lost pixels filled [mm]
  float* foreground = nullptr;           ///< of it what may be a part [mm]
  std::uint8_t* keep = nullptr;          ///< the mask
  std::uint32_t* bins = nullptr;         ///< kNoiseBins, all 0 before and after
  double* parts = nullptr;               ///< kImageParts sums of second differences [mm]
  SampleArrays samples[2];               ///< see mostSamples()
  const std::uint64_t* draws = nullptr;  ///< kDrawsOfRound for each round
  ForegroundState* state = nullptr;
};

void depthNoise(const ForegroundMemory& memory, const Camera& camera, cudaStream_t stream);
/// After depthNoise.
void fillDropouts(const ForegroundMemory& memory, const Camera& camera, cudaStream_t stream);
/// After fillDropouts.
void takeSamples(const ForegroundMemory& memory, const ForegroundRules& rules, cudaStream_t stream);
/// After takeSamples; rounds come in order, from 0. Those after the last plane do nothing.
void findPlanes(const ForegroundMemory& memory,
                const ForegroundRules& rules,
                int first_round,
                int rounds,
                cudaStream_t stream);
/// By the planes found so far.
void maskForeground(const ForegroundMemory& memory,
                    const ForegroundRules& rules,
                    cudaStream_t stream);

/// Four keys, see extentOfPart().
void extentOf(const float* foreground_mm,
              const Camera& camera,
              unsigned long long* keys,
              cudaStream_t stream);

}  // namespace rangepose::cuda
