#include "cuda/search_cuda.h"

#include "core/error.h"
#include "cuda/check.h"
#include "cuda/packed_views.h"

namespace rangepose::cuda {

Searcher::Known Searcher::upload(const ReferenceObject& object, cudaStream_t stream) {
  Known result{ResidentObject(object, stream), std::nullopt, std::nullopt};
  if (!staged_) return result;
  result.atlas.emplace(
      workspace_.memory(), Element::kFloat4, object.atlas.width(), object.atlas.height());
  Frame({&*result.atlas}, stream).upload(*result.atlas, object.atlas.data());
  result.programs.emplace(static_cast<int>(object.views.size()), object.size);
  return result;
}

std::shared_ptr<Searcher::Known> Searcher::known(const ReferenceObject& object,
                                                 cudaStream_t stream) {
  return objects_.of(object.serial, [&] { return upload(object, stream); });
}

template <typename Work>
void Searcher::withStaged(Known& known,
                          const CudaScene& window,
                          const SearchSetup& setup,
                          cudaStream_t stream,
                          const Work& work) {
  const Frame mapped({&*known.atlas, &window.range(), &window.distance()}, stream);
  work(StagedInput{known.object,
                   mapped.view(*known.atlas),
                   mapped.view(window.range()),
                   mapped.view(window.distance()),
                   setup});
}

void Searcher::frameWindows(const std::vector<const CudaScene*>& windows,
                            const WindowFrame& frame,
                            float outside_distance,
                            cudaStream_t stream) {
  const auto texels = static_cast<std::size_t>(frame.texels());
  windows_.reserve(texels * windows.size());
  std::vector<const DeviceImage*> images;
  for (const CudaScene* window : windows) {
    images.push_back(&window->range());
    images.push_back(&window->distance());
  }
  const Frame mapped(images, stream);
  for (std::size_t i = 0; i < windows.size(); ++i) {
    frameWindow(mapped.view(windows[i]->range()),
                mapped.view(windows[i]->distance()),
                outside_distance,
                frame,
                windows_.data() + i * texels,
                stream);
  }
}

namespace {

/// All windows of a call are squares of one size.
int sizeOf(const std::vector<const CudaScene*>& windows) {
  const int width = windows.front()->camera().width;
  for (const CudaScene* window : windows) {
    RP_CHECK(window->camera().width == width && window->camera().height == width,
             "search: windows must be squares of one size");
  }
  return width;
}

}  // namespace

std::vector<Hypothesis> Searcher::search(const ReferenceObject& object,
                                         const std::vector<const ResidentScene*>& scenes,
                                         const std::vector<float>& seed_range_px,
                                         const SearchOptions& options) {
  RP_CHECK(scenes.size() == seed_range_px.size(), "one seed range a window is needed");
  if (scenes.empty()) return {};
  std::vector<const CudaScene*> windows;
  for (const ResidentScene* scene : scenes) windows.push_back(&ownImage<CudaScene>(*scene));
  const cudaStream_t stream = workspace_.begin();
  const SearchSetup setup = searchSetup(object, sizeOf(windows), options);
  const std::shared_ptr<Known> views = known(object, stream);
  const std::size_t count = object.views.size() * windows.size();
  answers_.reserve(count);
  if (staged_) {
    for (std::size_t w = 0; w < windows.size(); ++w) {
      withStaged(*views, *windows[w], setup, stream, [&](const StagedInput& in) {
        views->programs->search(in,
                                seed_range_px[w],
                                static_cast<int>(w),
                                answers_.data() + w * object.views.size(),
                                stream);
      });
    }
    return answers_.download(count, stream);
  }
  frameWindows(windows, setup.frame, views->object.outsideDistance(), stream);
  seeds_.reserve(seed_range_px.size());
  seeds_.upload(seed_range_px.data(), seed_range_px.size(), stream);
  cuda::search(views->object,
               setup,
               windows_.data(),
               seeds_.data(),
               static_cast<int>(windows.size()),
               answers_.data(),
               stream);
  return answers_.download(count, stream);
}

std::vector<ErrorTerms> Searcher::errorTerms(const ReferenceObject& object,
                                             const CudaScene& window,
                                             const std::vector<glm::vec3>& translations_px,
                                             const ErrorOptions& options) {
  RP_CHECK(translations_px.size() == object.views.size(), "one translation a view is needed");
  const cudaStream_t stream = workspace_.begin();
  SearchOptions search_options;
  search_options.error = options;
  const SearchSetup setup = searchSetup(object, sizeOf({&window}), search_options);
  const std::shared_ptr<Known> views = known(object, stream);
  if (staged_) {
    std::vector<SimplexState> states;
    states.reserve(translations_px.size());
    for (const glm::vec3& at : translations_px) {
      states.push_back(simplexStart(at.x, at.y, at.z, search_options.simplex.step_px));
    }
    std::vector<ErrorTerms> terms(states.size());
    withStaged(*views, window, setup, stream, [&](const StagedInput& in) {
      RP_CUDA(cudaMemcpyAsync(views->programs->states(),
                              states.data(),
                              states.size() * sizeof(SimplexState),
                              cudaMemcpyHostToDevice,
                              stream));
      views->programs->evaluate(in, stream);
      RP_CUDA(cudaMemcpyAsync(terms.data(),
                              views->programs->terms(),
                              terms.size() * sizeof(ErrorTerms),
                              cudaMemcpyDeviceToHost,
                              stream));
      workspace_.synchronize();
    });
    return terms;
  }
  frameWindows({&window}, setup.frame, views->object.outsideDistance(), stream);
  translations_.reserve(translations_px.size());
  translations_.upload(translations_px.data(), translations_px.size(), stream);
  terms_.reserve(translations_px.size());
  cuda::errorTerms(
      views->object, setup, windows_.data(), translations_.data(), terms_.data(), stream);
  return terms_.download(translations_px.size(), stream);
}

std::vector<SimplexState> Searcher::simplexSteps(const std::vector<SimplexState>& states,
                                                 const std::vector<float>& values,
                                                 const SimplexOptions& options) {
  options.check();
  RP_CHECK(states.size() == values.size(), "one value a simplex is needed");
  if (states.empty()) return {};
  const cudaStream_t stream = workspace_.begin();
  states_.reserve(states.size());
  states_.upload(states.data(), states.size(), stream);
  values_.reserve(values.size());
  values_.upload(values.data(), values.size(), stream);
  cuda::simplexSteps(
      states_.data(), values_.data(), static_cast<int>(states.size()), options, stream);
  return states_.download(states.size(), stream);
}

}  // namespace rangepose::cuda
