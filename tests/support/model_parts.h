// Databases of the parts in models/, and of others, for tests of the whole method.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "database/reference_database.h"
#include "geometry/orientation_grid.h"
#include "io/mesh_file.h"
#include "stages/reference_host.h"

namespace rangepose::test {

inline Mesh modelMesh(const std::string& part) {
  return readMesh(std::filesystem::path(RP_MODELS_DIR) / (part + ".ply"), LengthUnit::kMillimetre);
}

/// As `rangepose build` makes it, with 64 px wide views; object i has id i + 1.
inline ReferenceDatabase databaseOfMeshes(const std::vector<Mesh>& meshes, int views = 1024) {
  const ChannelOptions options = channelOptionsFor(64);
  ReferenceDatabase database;
  for (const Mesh& mesh : meshes) {
    const int id = static_cast<int>(database.objects.size()) + 1;
    database.objects.push_back(describeObject(mesh, id, 64, uniformRotations(views), options));
    setSymmetries(database.objects.back(), findSymmetries(mesh));
    host::renderReferences(database.objects.back(), options, {});
  }
  return database;
}

}  // namespace rangepose::test
