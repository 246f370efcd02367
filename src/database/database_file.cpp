#include <cmath>
#include <fstream>

#include "core/byte_stream.h"
#include "database/reference_database.h"
#include "geometry/surface_sample.h"

namespace rangepose {
namespace {

constexpr FileKind kDatabase = {{'R', 'P', 'D', 'B'}, 4, "database", "build the database again"};
constexpr std::size_t kMaxSymmetries = 1000;
constexpr int kMaxViews = 65536;

void writeMesh(ByteWriter& out, const Mesh& mesh) {
  out.text(mesh.name);
  out.value(static_cast<std::uint64_t>(mesh.vertices.size()));
  out.array(mesh.vertices.data(), mesh.vertices.size());
  out.value(static_cast<std::uint64_t>(mesh.triangles.size()));
  out.array(mesh.triangles.data(), mesh.triangles.size());
}

Mesh readMesh(ByteReader& in) {
  Mesh mesh;
  mesh.name = in.text();
  mesh.vertices.resize(in.count(sizeof(glm::vec3)));
  in.array(mesh.vertices.data(), mesh.vertices.size());
  mesh.triangles.resize(in.count(sizeof(glm::uvec3)));
  in.array(mesh.triangles.data(), mesh.triangles.size());
  checkMesh(mesh);
  return mesh;
}

void writePoses(ByteWriter& out, const std::vector<Pose>& poses) {
  out.value(static_cast<std::uint64_t>(poses.size()));
  out.array(poses.data(), poses.size());
}

void writeSymmetries(ByteWriter& out, const Symmetries& symmetries) {
  writePoses(out, symmetries.discrete);
  out.value(static_cast<std::uint64_t>(symmetries.continuous.size()));
  out.array(symmetries.continuous.data(), symmetries.continuous.size());
}

bool finite(const glm::dvec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

std::vector<Pose> readPoses(ByteReader& in, const char* what) {
  std::vector<Pose> poses(in.count(sizeof(Pose)));
  in.array(poses.data(), poses.size());
  bool sound = poses.size() <= kMaxSymmetries;
  for (const Pose& pose : poses) {
    sound = sound && finite(pose.rotation[0]) && finite(pose.rotation[1]) &&
            finite(pose.rotation[2]) && finite(pose.translation_mm);
  }
  if (!sound) in.fail(std::string("impossible ") + what);
  return poses;
}

Symmetries readSymmetries(ByteReader& in) {
  Symmetries symmetries;
  symmetries.discrete = readPoses(in, "symmetries");
  symmetries.continuous.resize(in.count(sizeof(SymmetryAxis)));
  in.array(symmetries.continuous.data(), symmetries.continuous.size());
  bool sound = symmetries.continuous.size() <= kMaxSymmetries;
  for (const SymmetryAxis& axis : symmetries.continuous) {
    sound = sound && finite(axis.direction) && finite(axis.point_mm);
  }
  if (!sound) in.fail("impossible symmetries");
  return symmetries;
}

void writeObject(ByteWriter& out, const ReferenceObject& object) {
  out.value(static_cast<std::int32_t>(object.id));
  writeMesh(out, object.mesh);
  writeSymmetries(out, object.symmetries);
  writePoses(out, object.twins);
  out.value(object.center_mm);
  out.value(object.radius_mm);
  out.value(object.diameter_mm);
  out.value(object.pixel_mm);
  out.value(static_cast<std::int32_t>(object.size));
  out.value(static_cast<std::int32_t>(object.edt_passes));
  out.value(static_cast<std::uint64_t>(object.views.size()));
  for (std::size_t i = 0; i < object.views.size(); ++i) {
    const ReferenceView& view = object.views[i];
    out.value(view.rotation);
    out.value(view.box);
    out.value(view.area_px);
    out.value(view.anchor_px);
    const glm::ivec2 origin = object.tileOrigin(static_cast<int>(i));
    for (int v = view.box.y0; v < view.box.y1; ++v) {
      out.array(object.atlas.row(origin.y + v) + origin.x + view.box.x0,
                static_cast<std::size_t>(view.box.width()));
    }
  }
}

bool positive(double value) { return std::isfinite(value) && value > 0.0; }

ReferenceObject readObject(ByteReader& in) {
  ReferenceObject object;
  object.id = in.value<std::int32_t>();
  object.mesh = readMesh(in);
  object.symmetries = readSymmetries(in);
  object.twins = readPoses(in, "twins");
  object.center_mm = in.value<glm::dvec3>();
  object.radius_mm = in.value<double>();
  object.diameter_mm = in.value<double>();
  object.pixel_mm = in.value<double>();
  object.size = in.value<std::int32_t>();
  object.edt_passes = in.value<std::int32_t>();
  if (!positive(object.radius_mm) || !positive(object.diameter_mm) || !positive(object.pixel_mm) ||
      object.size < 16 || object.size > 128 || object.edt_passes < 1 || object.edt_passes > 255) {
    in.fail("object " + std::to_string(object.id) + " has impossible sizes");
  }
  measureShape(object);
  const std::size_t views = in.count(sizeof(glm::dmat3));
  if (views < 1 || views > kMaxViews) in.fail("impossible number of views");
  object.views.resize(views);
  const int columns = atlasColumns(static_cast<int>(views));
  const int rows = (static_cast<int>(views) + columns - 1) / columns;
  object.atlas =
      Image<ReferenceTexel>(columns * object.size, rows * object.size, ReferenceTexel(0.0f));
  for (std::size_t i = 0; i < views; ++i) {
    ReferenceView& view = object.views[i];
    view.rotation = in.value<glm::dmat3>();
    view.box = in.value<PixelBox>();
    view.area_px = in.value<float>();
    view.anchor_px = in.value<glm::vec3>();
    const PixelBox& box = view.box;
    if (box.x0 < 0 || box.y0 < 0 || box.x1 > object.size || box.y1 > object.size ||
        box.x0 > box.x1 || box.y0 > box.y1) {
      in.fail("view " + std::to_string(i) + " has a box outside of its tile");
    }
    const glm::ivec2 origin = object.tileOrigin(static_cast<int>(i));
    for (int v = box.y0; v < box.y1; ++v) {
      in.array(object.atlas.row(origin.y + v) + origin.x + box.x0,
               static_cast<std::size_t>(box.width()));
    }
  }
  return object;
}

}  // namespace

std::vector<char> serialize(const ReferenceDatabase& database) {
  ByteWriter payload;
  payload.value(static_cast<std::uint64_t>(database.objects.size()));
  for (const ReferenceObject& object : database.objects) writeObject(payload, object);
  return framed(kDatabase, payload.take());
}

ReferenceDatabase deserialize(const std::vector<char>& bytes, const std::string& where) {
  ByteReader in = payloadOf(kDatabase, bytes, where);
  ReferenceDatabase database;
  database.objects.resize(in.count(sizeof(ReferenceView)));
  if (database.objects.empty()) in.fail("database without objects");
  for (ReferenceObject& object : database.objects) object = readObject(in);
  if (in.left() != 0) in.fail("bytes after the last object");
  return database;
}

ReferenceDatabase readDatabase(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  if (!file || std::filesystem::is_directory(path)) {
    throw Error(path.string() + ": cannot open the database; make one with `rangepose build`");
  }
  const std::streamoff size = file.tellg();
  std::vector<char> bytes(size > 0 ? static_cast<std::size_t>(size) : 0);
  file.seekg(0);
  file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (!file) throw Error(path.string() + ": cannot read the database");
  return deserialize(bytes, path.string());
}

std::uint64_t databaseChecksum(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  const std::optional<std::uint64_t> sum = statedChecksum(file);
  if (sum) return *sum;
  throw Error(path.string() + ": cannot read the database; make one with `rangepose build`");
}

}  // namespace rangepose
