// The reference database: all objects that may be in a scene, with their views (paper Sect. 4), and
// its file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <vector>

#include "stages/reference.h"
#include "stages/scene_channels.h"

namespace rangepose {

struct ReferenceDatabase {
  std::vector<ReferenceObject> objects;
};

/// Sets what follows from the mesh and its diameter alone: thickness and flat faces.
void measureShape(ReferenceObject& object);

/// An object with its scale and the orientations of its views, not rendered yet. Throws Error for a
/// mesh that checkMesh refuses or for a size or number of views out of range (16..128
/// px, 1..65536).
///
/// The bounding sphere fills the tile but for a margin of kTileMarginPx, so no view is cut off.
///
/// Its symmetries are left empty: set them (setSymmetries, findSymmetries), or poses that are the
/// same by symmetry compete with each other and share their confidence.
ReferenceObject describeObject(const Mesh& mesh,
                               int id,
                               int size_px,
                               const std::vector<glm::dmat3>& rotations,
                               const ChannelOptions& options);

/// Sets the symmetries of an object and finds its twins, which depend on them.
void setSymmetries(ReferenceObject& object, const Symmetries& symmetries);

/// Pixels between the bounding sphere and the border of a tile: room for an edge and its
/// neighbours.
inline constexpr double kTileMarginPx = 2.0;

/// Channel options for references of `size_px`: the paper's 7 passes at 64x64, in proportion
/// otherwise.
ChannelOptions channelOptionsFor(int size_px);

/// Channel options that made the references of this object; scene windows must use the same.
ChannelOptions channelOptionsOf(const ReferenceObject& object);

/// The file's content. Only the boxes of the views are kept; the rest of a tile is background.
std::vector<char> serialize(const ReferenceDatabase& database);

/// Reads what `serialize` wrote. Throws Error, naming `where`, for anything else: wrong type, other
/// version, truncated, damaged (checksum), or with sizes that do not fit.
ReferenceDatabase deserialize(const std::vector<char>& bytes, const std::string& where);

/// Reads a database file; throws Error when it is missing or not a sound database.
ReferenceDatabase readDatabase(const std::filesystem::path& path);

/// Tells databases with different content apart: the checksum that the file itself carries. Throws
/// Error when it is missing or too short.
std::uint64_t databaseChecksum(const std::filesystem::path& path);

}  // namespace rangepose
