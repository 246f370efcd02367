// Windows that show a view of an object before other surfaces, and the fused search run on the
// host: what the tests of its body and of its kernel compare with.
#pragma once

#include <memory>
#include <vector>

#include "cuda/packed_views.h"
#include "cuda/search_body.h"
#include "stages/channels_host.h"
#include "stages/reference_host.h"
#include "support/box_mesh.h"
#include "support/range_scenes.h"

namespace rangepose::test {

inline ReferenceObject renderedBracket(int views, int size, unsigned seed) {
  ReferenceObject object = objectOf(bracketBoxes(), views, size, seed);
  host::renderReferences(object, {}, {});
  return object;
}

/// The view with its anchor at the window's centre, among blobs behind it.
inline SceneChannels windowWith(const ReferenceObject& object, int view, unsigned seed) {
  const int width = kWindowScale * object.size;
  const float shift_range = 20.0f + static_cast<float>(view);
  Image<float> range = randomBlobs(width, width, seed);
  for (float& value : range) value = value == 0.0f ? 0.0f : value + 200.0f;
  const glm::vec3 anchor = object.views[static_cast<std::size_t>(view)].anchor_px;
  const glm::ivec2 origin = object.tileOrigin(view);
  for (int v = 0; v < object.size; ++v) {
    for (int u = 0; u < object.size; ++u) {
      const ReferenceTexel texel = object.atlas.at(origin.x + u, origin.y + v);
      const int x = width / 2 + u - static_cast<int>(anchor.x);
      const int y = width / 2 + v - static_cast<int>(anchor.y);
      if (texel.a > 0.0f && range.contains(x, y)) range.at(x, y) = texel.g + shift_range;
    }
  }
  OrthoCamera camera;
  camera.width = width;
  camera.height = width;
  return host::channels(camera, range, {});
}

inline float seedRange(const SceneChannels& window) {
  return window.range_px.at(window.range_px.width() / 2, window.range_px.height() / 2);
}

/// Some beyond the largest shift, some that read past the window.
inline std::vector<glm::vec3> scatteredTranslations(const ReferenceObject& object, unsigned seed) {
  Random random(seed);
  const double size = object.size;
  std::vector<glm::vec3> translations;
  for (std::size_t i = 0; i < object.views.size(); ++i) {
    translations.emplace_back(random.uniform(-0.8, 0.8) * size,
                              random.uniform(-0.8, 0.8) * size,
                              random.uniform(-10.0, 60.0) + size);
  }
  translations[0] = {-0.5f, 0.5f, static_cast<float>(size) + 20.0f};
  return translations;
}

inline std::vector<cuda::WindowTexel> framed(const SceneChannels& window,
                                             const cuda::WindowFrame& frame,
                                             float outside_distance) {
  std::vector<cuda::WindowTexel> texels;
  for (int y = 0; y < frame.stride(); ++y) {
    for (int x = 0; x < frame.stride(); ++x) {
      texels.push_back(cuda::framedTexel(
          frame,
          outside_distance,
          x,
          y,
          [&](int u, int v) { return window.range_px.at(u, v); },
          [&](int u, int v) { return window.distance_px.at(u, v); }));
    }
  }
  return texels;
}

/// Of an object in one window, as the kernels get it.
struct FusedInput {
  FusedInput(const ReferenceObject& object,
             const SceneChannels& window,
             const SearchOptions& options)
      : views(cuda::packViews(object)),
        setup(cuda::searchSetup(object, window.range_px.width(), options)),
        texels(framed(window, setup.frame, -static_cast<float>(object.edt_passes + 1))),
        seed_range_px(seedRange(window)) {}

  cuda::PackedViews views;
  cuda::SearchSetup setup;
  std::vector<cuda::WindowTexel> texels;
  float seed_range_px;
};

/// The body of the fused search, thread after thread.
template <int kSlots, int kThreads>
std::vector<Hypothesis> fusedOnHost(const FusedInput& in) {
  std::vector<Hypothesis> answers(in.views.entries.size());
  auto block = std::make_unique<cuda::HostBlock<kThreads>>();
  for (std::size_t i = 0; i < answers.size(); ++i) {
    cuda::SearchShared shared{};
    answers[i].view = static_cast<int>(i);
    cuda::searchView<kSlots>(*block,
                             shared,
                             in.setup,
                             in.views.entries[i],
                             in.views.pixels.data(),
                             in.texels.data(),
                             in.seed_range_px,
                             answers[i]);
  }
  return answers;
}

template <int kSlots, int kThreads>
std::vector<ErrorTerms> termsOnHost(const FusedInput& in,
                                    const std::vector<glm::vec3>& translations) {
  std::vector<ErrorTerms> terms(in.views.entries.size());
  cuda::HostBlock<kThreads> block;
  for (std::size_t i = 0; i < terms.size(); ++i) {
    cuda::sumView<kSlots>(block,
                          in.setup,
                          in.views.entries[i],
                          in.views.pixels.data(),
                          in.texels.data(),
                          translations[i],
                          terms[i]);
  }
  return terms;
}

}  // namespace rangepose::test
