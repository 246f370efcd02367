// Kernels alone, timed by events on the device: what the calls of StageSet take without uploads,
// downloads and waiting.
#include "cuda/buffer.h"
#include "cuda/check.h"
#include "cuda/packed_views.h"
#include "cuda/scene_cuda.h"
#include "cuda/search.h"
#include "cuda/staged_search.h"
#include "cuda/stream.h"
#include "device_bench/rows.h"

namespace rangepose::device_bench {
namespace {

class KernelRows {
 public:
  KernelRows(const Workload& load, int runs)
      : load_(load),
        runs_(runs),
        workspace_(nullptr, cuda::DeviceImage::Memory::kOwn),
        stream_(workspace_.begin()),
        object_(load.object(), stream_),
        setup_(cuda::searchSetup(load.object(), windowWidth(), load.first().search)) {
    for (const SceneChannels& window : load.first().windows)
      windows_.push_back(cuda::uploadScene(workspace_, window));
  }

  std::vector<Row> all() {
    const auto count = static_cast<int>(windows_.size());
    const auto texels = static_cast<std::size_t>(setup_.frame.texels());
    const cuda::Buffer<cuda::WindowTexel> framed(texels * windows_.size());
    const cuda::Buffer<float> seeds(load_.first().seed_range_px, stream_);
    const cuda::Buffer<Hypothesis> answers(load_.object().views.size() * windows_.size());
    add("frames of the windows", {}, [&] { frame(framed, texels); });
    const Work work = searchWork(load_, *makeHostStages());
    add("fused search", work, [&] {
      cuda::search(object_, setup_, framed.data(), seeds.data(), count, answers.data(), stream_);
    });
    staged(work, answers);
    return std::move(rows_);
  }

 private:
  int windowWidth() const { return load_.first().windows.front().camera.width; }

  template <typename Launch>
  void add(const std::string& what,
           const Work& work,
           const Launch& launch,
           const std::string& path = "cuda, kernels alone") {
    Row row = timed(what, path, runs_, [&] {
      begin_.record(stream_);
      launch();
      end_.record(stream_);
      return static_cast<double>(elapsedMs(begin_, end_));
    });
    row.work = work;
    row.on_gpu = true;
    rows_.push_back(row);
  }

  void frame(const cuda::Buffer<cuda::WindowTexel>& framed, std::size_t texels) {
    for (std::size_t i = 0; i < windows_.size(); ++i) {
      const cuda::CudaScene& scene = *windows_[i];
      const cuda::Frame mapped({&scene.range(), &scene.distance()}, stream_);
      cuda::frameWindow(mapped.view(scene.range()),
                        mapped.view(scene.distance()),
                        object_.outsideDistance(),
                        setup_.frame,
                        framed.data() + i * texels,
                        stream_);
    }
  }

  void staged(const Work& work, const cuda::Buffer<Hypothesis>& answers) {
    const Image<ReferenceTexel>& atlas = load_.object().atlas;
    cuda::Array texture(cuda::Element::kFloat4, atlas.width(), atlas.height());
    texture.upload(atlas.data(), stream_);
    const std::size_t views = load_.object().views.size();
    cuda::StagedSearch search(static_cast<int>(views), load_.object().size);
    add(
        "staged search",
        work,
        [&] {
          for (std::size_t i = 0; i < windows_.size(); ++i) {
            const cuda::CudaScene& scene = *windows_[i];
            const cuda::Frame mapped({&scene.range(), &scene.distance()}, stream_);
            const cuda::StagedInput in{object_,
                                       texture.view(),
                                       mapped.view(scene.range()),
                                       mapped.view(scene.distance()),
                                       setup_};
            search.search(in,
                          load_.first().seed_range_px[i],
                          static_cast<int>(i),
                          answers.data() + i * views,
                          stream_);
          }
        },
        // Only the device knows how many steps it takes, so the host asks now and then.
        "cuda, kernels and the host's waits in between");
  }

  const Workload& load_;
  int runs_;
  cuda::Workspace workspace_;
  cudaStream_t stream_;
  cuda::ResidentObject object_;
  cuda::SearchSetup setup_;
  std::vector<std::unique_ptr<cuda::CudaScene>> windows_;
  cuda::Event begin_;
  cuda::Event end_;
  std::vector<Row> rows_;
};

}  // namespace

void waitForDevice() { RP_CUDA(cudaDeviceSynchronize()); }

std::vector<Row> kernelRows(const Workload& load, int runs) { return KernelRows(load, runs).all(); }

}  // namespace rangepose::device_bench
