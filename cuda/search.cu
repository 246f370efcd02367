// How the work is laid out, for 1,024 views of 64x64 px in 3 windows (1,500 covered pixels a view,
// 50 evaluations a simplex). Reckoned for an H200, 132 multiprocessors, not measured:
// - One block of 256 threads for each view and window: 3,072 blocks, 3 of them at a time on a
//   multiprocessor, so a long search fills the gaps of others. All windows of a view in one block
//   would save 2 of 3 reads of the views, 50 MB of 75 MB: 10 us at 4.8 TB/s.
// - A view's pixels (16 bytes each, 24 kB) are read once and stay in registers, 3 to 12 pixels a
//   thread. From shared memory they would cost a load an evaluation and pixel, and would take the
//   place of the first-level cache that holds the window's middle (80 x 80 texels of 8 bytes, 51
//   kB).
// - 3,072 x 50 x 1,500 = 230 million pixels are evaluated, each one load of 8 bytes from that cache
//   and about 18 instructions: 130 million of a warp, 0.15 ms at four a cycle and 1.7 GHz. The
//   reductions add two fifths. While one thread steps the simplex its block waits; other blocks
//   fill that gap or do not: what a measurement has to tell.
#include "cuda/launch.h"
#include "cuda/search.h"
#include "cuda/search_body.h"

namespace rangepose::cuda {
namespace {

constexpr int kThreads = kSearchThreads;
using Block = DeviceBlock<kThreads>;

/// Blocks that must fit on a multiprocessor at once: what registers allow without spills.
constexpr int residentBlocks(int slots) { return slots > 6 ? 2 : slots > 3 ? 3 : 4; }

template <int kSlots>
__global__ __launch_bounds__(kThreads, residentBlocks(kSlots)) void searchKernel(
    const __grid_constant__ SearchSetup setup,
    const ViewEntry* __restrict__ views,
    const ViewPixel* __restrict__ pixels,
    const WindowTexel* __restrict__ windows,
    const float* __restrict__ seed_range_px,
    Hypothesis* __restrict__ answers) {
  __shared__ SearchShared shared;
  const int view = static_cast<int>(blockIdx.x);
  const int window = static_cast<int>(blockIdx.y);
  Hypothesis& answer = answers[window * setup.views + view];
  Block block;
  searchView<kSlots>(block,
                     shared,
                     setup,
                     views[view],
                     pixels,
                     windows + static_cast<std::size_t>(window) * setup.frame.texels(),
                     seed_range_px[window],
                     answer);
  block.leader([&] {
    answer.view = view;
    answer.window = window;
  });
}

__global__ __launch_bounds__(kThreads) void termsKernel(const __grid_constant__ SearchSetup setup,
                                                        const ViewEntry* __restrict__ views,
                                                        const ViewPixel* __restrict__ pixels,
                                                        const WindowTexel* __restrict__ window,
                                                        const glm::vec3* __restrict__ translations,
                                                        ErrorTerms* __restrict__ terms) {
  const int view = static_cast<int>(blockIdx.x);
  Block block;
  sumView<0>(block, setup, views[view], pixels, window, translations[view], terms[view]);
}

__global__ void frameKernel(
    ImageView range, ImageView distance, float outside, WindowFrame frame, WindowTexel* into) {
  const int x = static_cast<int>(blockIdx.x * blockDim.x + threadIdx.x);
  const int y = static_cast<int>(blockIdx.y);
  if (x >= frame.stride()) return;
  const auto reader = [](const ImageView& image) {
    return [texture = image.texture](int u, int v) {
      return tex2D<float>(texture, static_cast<float>(u) + 0.5f, static_cast<float>(v) + 0.5f);
    };
  };
  into[y * frame.stride() + x] = framedTexel(frame, outside, x, y, reader(range), reader(distance));
}

template <int kSlots>
void launchSearch(const ResidentObject& object,
                  const SearchSetup& setup,
                  const WindowTexel* windows,
                  const float* seed_range_px,
                  int window_count,
                  Hypothesis* answers,
                  cudaStream_t stream) {
  const dim3 grid(static_cast<unsigned>(setup.views), static_cast<unsigned>(window_count));
  launch(searchKernel<kSlots>,
         grid,
         kThreads,
         stream,
         setup,
         object.entries(),
         object.pixels(),
         windows,
         seed_range_px,
         answers);
  RP_LAUNCHED("fused search");
}

}  // namespace

void search(const ResidentObject& object,
            const SearchSetup& setup,
            const WindowTexel* windows,
            const float* seed_range_px,
            int window_count,
            Hypothesis* answers,
            cudaStream_t stream) {
  RP_CHECK(setup.views == object.views(), "the setup belongs to another object");
  if (setup.views == 0 || window_count == 0) return;
  const int slots = searchSlots(object.mostPixels(setup.row_step));
  const auto launch_slots = slots == 3    ? launchSearch<3>
                            : slots == 6  ? launchSearch<6>
                            : slots == 12 ? launchSearch<12>
                                          : launchSearch<0>;
  launch_slots(object, setup, windows, seed_range_px, window_count, answers, stream);
}

void errorTerms(const ResidentObject& object,
                const SearchSetup& setup,
                const WindowTexel* window,
                const glm::vec3* translations_px,
                ErrorTerms* terms,
                cudaStream_t stream) {
  RP_CHECK(setup.views == object.views(), "the setup belongs to another object");
  if (setup.views == 0) return;
  launch(termsKernel,
         static_cast<unsigned>(setup.views),
         kThreads,
         stream,
         setup,
         object.entries(),
         object.pixels(),
         window,
         translations_px,
         terms);
  RP_LAUNCHED("error terms");
}

void frameWindow(ImageView range_px,
                 ImageView distance_px,
                 float outside_distance,
                 const WindowFrame& frame,
                 WindowTexel* into,
                 cudaStream_t stream) {
  constexpr unsigned kColumns = 64;
  const unsigned stride = static_cast<unsigned>(frame.stride());
  const dim3 grid((stride + kColumns - 1) / kColumns, stride);
  launch(frameKernel, grid, kColumns, stream, range_px, distance_px, outside_distance, frame, into);
  RP_LAUNCHED("frame of a window");
}

}  // namespace rangepose::cuda
