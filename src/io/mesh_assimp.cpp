#include "io/mesh_assimp.h"

#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <assimp/Importer.hpp>
#include <exception>
#include <utility>
#include <vector>

#include "core/error.h"
#include "io/file_bytes.h"
#include "io/mesh_file.h"

namespace rangepose {
namespace {

using Matrix = aiMatrix4x4t<double>;

void appendMesh(const aiMesh& source, const Matrix& transform, double scale, Mesh& target) {
  const auto first = static_cast<unsigned>(target.vertices.size());
  for (unsigned i = 0; i < source.mNumVertices; ++i) {
    const aiVector3D& v = source.mVertices[i];
    const aiVector3t<double> moved =
        transform * aiVector3t<double>(double{v.x}, double{v.y}, double{v.z});
    target.vertices.emplace_back(scale * moved.x, scale * moved.y, scale * moved.z);
  }
  // A mirroring transform turns faces inside out.
  const bool mirrored = transform.Determinant() < 0.0;
  for (unsigned i = 0; i < source.mNumFaces; ++i) {
    const aiFace& face = source.mFaces[i];
    if (face.mNumIndices != 3) continue;  // points and lines
    glm::uvec3 triangle{face.mIndices[0], face.mIndices[1], face.mIndices[2]};
    if (mirrored) std::swap(triangle.y, triangle.z);
    target.triangles.push_back(triangle + first);
  }
}

Mesh joinScene(const aiScene& scene, double scale, const std::string& where) {
  Mesh joined;
  std::size_t faces = 0;
  std::vector<std::pair<const aiNode*, Matrix>> open{{scene.mRootNode, Matrix()}};
  while (!open.empty()) {
    const auto [node, parent] = open.back();
    open.pop_back();
    const Matrix transform = parent * Matrix(node->mTransformation);
    for (unsigned i = 0; i < node->mNumMeshes; ++i) {
      const aiMesh& mesh = *scene.mMeshes[node->mMeshes[i]];
      faces += mesh.mNumFaces;
      checkFaceCount(faces, where);
      appendMesh(mesh, transform, scale, joined);
    }
    for (unsigned i = node->mNumChildren; i > 0; --i) {
      open.emplace_back(node->mChildren[i - 1], transform);
    }
  }
  return joined;
}

}  // namespace

Mesh importScene(const std::filesystem::path& path, double scale, const std::string& where) {
  Assimp::Importer importer;
  importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE,
                              aiPrimitiveType_POINT | aiPrimitiveType_LINE);
  importer.SetPropertyBool(AI_CONFIG_IMPORT_NO_SKELETON_MESHES, true);
  // Validation comes first: later steps trust the indices of the file.
  constexpr unsigned kSteps =
      aiProcess_ValidateDataStructure | aiProcess_Triangulate | aiProcess_SortByPType;
  const aiScene* scene = nullptr;
  std::string reason;
  try {
    scene = importer.ReadFile(path.string(), kSteps);
    reason = importer.GetErrorString();
  } catch (const std::exception& failure) {
    reason = failure.what();
  }
  if (scene == nullptr || scene->mRootNode == nullptr) {
    throw Error(
        fmt::format("{}: not a readable mesh ({}); give a complete STL, OBJ, PLY, glTF or OFF file",
                    where,
                    oneLine(reason)));
  }
  return joinScene(*scene, scale, where);
}

}  // namespace rangepose
