// Makes the bins of `simulate`: drops parts, scans them, writes the scenes.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <mutex>
#include <string>
#include <vector>

#include "geometry/mesh.h"
#include "geometry/symmetry.h"
#include "io/bop_write.h"
#include "sim/drop.h"
#include "sim/scanner.h"

namespace rangepose::cli {

struct SimulateArguments {
  std::vector<std::string> models;
  std::string out;
  int bins = 9;
  int count = 25;          ///< parts in a bin
  std::uint64_t seed = 1;  ///< same seed, same files
  bool mixed = false;      ///< all models in each bin; else one model a bin in turn
  std::string unit = "mm";
  std::string size;                         ///< "640x480" [px]; empty: as the sensor has it
  std::string sensor = "structured-light";  ///< of sensorNames()
  std::string bin_size;                     ///< "300x200x100" [mm]; empty: as the parts need it
  int images = 1;  ///< of each bin, which is emptied from the top meanwhile
  double tilt_deg = 15.0;
  ScannerOptions scanner;
  DropOptions drop;
  int threads = 0;
};

class BinSimulator {
 public:
  /// Reads the models. `arguments` must outlive it.
  explicit BinSimulator(const SimulateArguments& arguments);

  /// Prepares the models for physics, says what they are, and writes them as those of the data set.
  void writeModels();
  /// Scene `bin + 1`: dropped, scanned, written. May run for several bins at the same time. Where
  /// `stop` is set meanwhile, nothing of the bin is written.
  void makeBin(int bin, const std::atomic<bool>& stop);
  /// Writes what concerns all scenes; the same whatever the order of the bins was.
  void finish();

  /// Scenes that are written.
  int scenes() const { return static_cast<int>(scenes_.size()); }

 private:
  struct SceneFacts {
    int scene_id = 0;
    Camera camera;
    std::vector<BopTarget> targets;
  };

  void describe(const PhysicsPart& part, const Symmetries& symmetries) const;
  BopView viewOf(int im_id, const DroppedBin& dropped, const Scan& scan) const;
  void write(int scene_id, const std::vector<BopView>& views);

  const SimulateArguments& arguments_;
  const std::filesystem::path out_;
  std::vector<Mesh> meshes_;
  std::vector<PhysicsPart> parts_;
  std::mutex mutex_;
  std::vector<SceneFacts> scenes_;
};

}  // namespace rangepose::cli
