// What the benchmarks run on: images, databases of the demo part, and what the host path makes of
// them.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "cuda/cuda_path.h"
#include "database/reference_database.h"
#include "gles/context.h"
#include "pipeline/estimate.h"

namespace rangepose::bench {

inline constexpr int kSizePx = 64;
inline constexpr int kStarts = 3;

/// A path that works on this machine.
struct Path {
  std::string name;
  StageSet* stages;
  bool software;  ///< shaders on the processor: too slow for whole searches
};

/// Everything is made on its first use and lives as long as the process.
class Fixture {
 public:
  Fixture();
  ~Fixture();

  const std::vector<Path>& paths() const { return paths_; }
  /// Null where no EGL context can be made; `noGlesReason` says why.
  gles::Context* context() { return context_.get(); }
  const std::string& noGlesReason() const { return no_gles_reason_; }
  const std::string& noCudaReason() const { return no_cuda_reason_; }

  const Mesh& mesh();
  /// models/elbow.ply with so many views.
  const ReferenceDatabase& database(int views);
  /// models/demo/depth.png, 640x480.
  const DepthImage& demo();
  /// A generated heap, 848x480.
  const DepthImage& heap();
  /// A bin of 25 elbows that fell into it, 640x480.
  struct Bin {
    DepthImage image;
    BinBox box;
  };
  const Bin& bin();
  /// The demo image as the host path takes it, with the database of so many views.
  const EstimateTrace& trace(int views);
  double noiseMm();
  /// Of the demo image, for parts of that database.
  Enclosure enclosure(int views);

 private:
  struct Views;
  Views& views(int count);

  std::unique_ptr<gles::Context> context_;
  std::string no_gles_reason_;
  std::string no_cuda_reason_;
  std::unique_ptr<StageSet> host_;
  std::unique_ptr<StageSet> glsl_;
  std::vector<cuda::Path> cuda_;  ///< fused, then staged
  std::vector<Path> paths_;
  std::unique_ptr<Mesh> mesh_;
  std::unique_ptr<DepthImage> demo_;
  std::unique_ptr<DepthImage> heap_;
  std::unique_ptr<Bin> bin_;
  std::vector<std::unique_ptr<Views>> views_;
};

void registerStageBenchmarks(Fixture& fixture);
void registerSearchBenchmarks(Fixture& fixture);
void registerRefineBenchmarks(Fixture& fixture);
void registerFrameBenchmarks(Fixture& fixture);
void registerDatabaseBenchmarks(Fixture& fixture);

}  // namespace rangepose::bench
