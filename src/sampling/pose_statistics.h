// How a part comes to lie: orientations of parts that fell into bins (paper Sect. 4.2), and their
// file, small enough to be shipped beside the mesh.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "core/glm.h"

namespace rangepose {

/// Orientations are camera_from_object of a camera that looks straight down, its x along the bin's.
///
/// All parts of a bin count, those below others too, as in the paper: as a bin is emptied each of
/// them comes to lie on top.
struct PoseStatistics {
  std::uint64_t mesh_hash = 0;        ///< of the mesh in millimetres (io/mesh_file.h)
  std::uint64_t seed = 0;             ///< of the simulation
  std::int32_t bins = 0;              ///< simulated
  std::int32_t parts = 0;             ///< observed in all bins
  std::vector<glm::dmat3> rotations;  ///< of the parts, or an even selection of them
};

/// Most orientations that a file holds: 48 kB.
inline constexpr std::size_t kMostKeptRotations = 8192;

/// The file's content: six bytes an orientation, exact to 0.01 degrees.
std::vector<char> serialize(const PoseStatistics& statistics);

/// Reads what `serialize` wrote. Throws Error, naming `where`, for anything else.
PoseStatistics deserializeStatistics(const std::vector<char>& bytes, const std::string& where);

/// Throws Error when the file is missing or not sound.
PoseStatistics readStatistics(const std::filesystem::path& path);

}  // namespace rangepose
