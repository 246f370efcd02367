// Layout: magic "RPDB", version, checksum of the payload, payload size, payload.
#include <array>
#include <cmath>
#include <fstream>

#include "database/byte_stream.h"
#include "database/reference_database.h"

namespace rangepose {
namespace {

constexpr std::array<char, 4> kMagic = {'R', 'P', 'D', 'B'};
constexpr std::uint32_t kVersion = 1;
constexpr int kMaxViews = 65536;

/// FNV-1a over words of eight bytes: each step is one to one, so a single damaged word always
/// shows.
std::uint64_t checksum(const char* data, std::size_t size) {
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  const auto mix = [&hash](std::uint64_t word) {
    hash = (hash ^ word) * 0x100000001b3ULL;
    hash ^= hash >> 32;
  };
  std::size_t i = 0;
  for (; i + 8 <= size; i += 8) {
    std::uint64_t word = 0;
    std::memcpy(&word, data + i, 8);
    mix(word);
  }
  for (; i < size; ++i) mix(static_cast<unsigned char>(data[i]));
  return hash;
}

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

void writeObject(ByteWriter& out, const ReferenceObject& object) {
  out.value(static_cast<std::int32_t>(object.id));
  writeMesh(out, object.mesh);
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
  const std::vector<char> body = payload.take();
  ByteWriter file;
  file.array(kMagic.data(), kMagic.size());
  file.value(kVersion);
  file.value(checksum(body.data(), body.size()));
  file.value(static_cast<std::uint64_t>(body.size()));
  file.array(body.data(), body.size());
  return file.take();
}

ReferenceDatabase deserialize(const std::vector<char>& bytes, const std::string& where) {
  ByteReader header(bytes.data(), bytes.size(), where);
  if (bytes.size() < kMagic.size() ||
      std::memcmp(bytes.data(), kMagic.data(), kMagic.size()) != 0) {
    throw Error(where + ": not a rangepose database; make one with `rangepose build`");
  }
  header.value<std::array<char, 4>>();
  const std::uint32_t version = header.value<std::uint32_t>();
  if (version != kVersion) {
    header.fail("database version " + std::to_string(version) + ", this program reads version " +
                std::to_string(kVersion));
  }
  const std::uint64_t expected = header.value<std::uint64_t>();
  const std::uint64_t size = header.value<std::uint64_t>();
  if (size > header.left()) header.fail("truncated database");
  if (size < header.left()) header.fail("bytes after the end of the database");
  const char* body = bytes.data() + (bytes.size() - header.left());
  if (checksum(body, header.left()) != expected) header.fail("damaged database (checksum)");
  ByteReader in(body, header.left(), where);
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

}  // namespace rangepose
