#include "io/ply_file.h"

#include <fmt/format.h>

#include "core/error.h"
#include "io/mesh_file.h"
#include "io/ply_cursor.h"
#include "io/ply_header.h"
#include "io/polygon.h"

namespace rangepose {
namespace {

constexpr std::int64_t kMaxVertices = 100'000'000;

const PlyElement* findElement(const PlyHeader& header, std::string_view name) {
  for (const PlyElement& element : header.elements) {
    if (element.name == name) return &element;
  }
  return nullptr;
}

void skipElement(const PlyElement& element, PlyCursor& cursor) {
  if (element.properties.empty()) return;
  for (std::int64_t i = 0; i < element.count; ++i) {
    for (const PlyProperty& property : element.properties) cursor.skip(property);
  }
}

/// Axis of a vertex property: 0, 1, 2 for x, y, z, -1 for others.
std::vector<int> axesOf(const PlyElement& element, const std::string& where) {
  std::vector<int> axes(element.properties.size(), -1);
  const std::string_view names = "xyz";
  for (int axis = 0; axis < 3; ++axis) {
    const int index = element.indexOf(names.substr(static_cast<std::size_t>(axis), 1));
    if (index < 0 || element.properties[static_cast<std::size_t>(index)].is_list) {
      throw Error(fmt::format("{}: the PLY element vertex has no number {}; it needs x, y and z",
                              where,
                              names[static_cast<std::size_t>(axis)]));
    }
    axes[static_cast<std::size_t>(index)] = axis;
  }
  return axes;
}

std::vector<glm::dvec3> takeVertices(const PlyElement& element,
                                     PlyCursor& cursor,
                                     const std::string& where) {
  if (element.count > kMaxVertices) {
    throw Error(fmt::format(
        "{}: {} vertices, more than {}; give a smaller file", where, element.count, kMaxVertices));
  }
  const std::vector<int> axes = axesOf(element, where);
  std::vector<glm::dvec3> points(static_cast<std::size_t>(element.count));
  for (glm::dvec3& point : points) {
    for (std::size_t p = 0; p < axes.size(); ++p) {
      const PlyProperty& property = element.properties[p];
      if (axes[p] < 0) {
        cursor.skip(property);
      } else {
        point[axes[p]] = cursor.take(property.type);
      }
    }
  }
  return points;
}

std::vector<unsigned> takeCorners(const PlyProperty& property,
                                  PlyCursor& cursor,
                                  std::size_t vertex_count,
                                  std::int64_t face,
                                  const std::string& where) {
  const int count = cursor.takeListLength(property);
  checkCornerCount(count, face, where);
  std::vector<unsigned> corners(static_cast<std::size_t>(count));
  for (unsigned& corner : corners) {
    corner = checkedCorner(cursor.take(property.type), vertex_count, face, where);
  }
  return corners;
}

void takeFaces(const PlyElement& element,
               PlyCursor& cursor,
               const std::string& where,
               RawMesh& mesh) {
  int list = element.indexOf("vertex_indices");
  if (list < 0) list = element.indexOf("vertex_index");
  if (list < 0 || !element.properties[static_cast<std::size_t>(list)].is_list) {
    throw Error(where + ": the PLY element face has no list vertex_indices");
  }
  for (std::int64_t face = 0; face < element.count; ++face) {
    for (std::size_t p = 0; p < element.properties.size(); ++p) {
      const PlyProperty& property = element.properties[p];
      if (static_cast<int>(p) != list) {
        cursor.skip(property);
        continue;
      }
      appendTriangles(mesh.vertices,
                      takeCorners(property, cursor, mesh.vertices.size(), face, where),
                      mesh.triangles);
    }
    checkFaceCount(mesh.triangles.size(), where);
  }
}

const PlyElement& vertexElement(const PlyHeader& header, const std::string& where) {
  const PlyElement* vertices = findElement(header, "vertex");
  if (vertices == nullptr) throw Error(where + ": the PLY has no element vertex");
  return *vertices;
}

}  // namespace

PlyVertices parsePlyVertices(std::string_view bytes, const std::string& where) {
  const PlyHeader header = parsePlyHeader(bytes, where);
  const PlyElement& vertices = vertexElement(header, where);
  PlyCursor cursor(header.format, header.body, where);
  PlyVertices result;
  for (const PlyElement& element : header.elements) {
    if (&element != &vertices) {
      skipElement(element, cursor);
      continue;
    }
    result.points = takeVertices(element, cursor, where);
    break;
  }
  if (header.grid_columns > 0 && header.grid_rows > 0 && header.grid_columns <= vertices.count &&
      header.grid_rows <= vertices.count &&
      header.grid_columns * header.grid_rows == vertices.count) {
    result.grid_width = static_cast<int>(header.grid_columns);
    result.grid_height = static_cast<int>(header.grid_rows);
  }
  return result;
}

RawMesh parsePlyMesh(std::string_view bytes, const std::string& where) {
  const PlyHeader header = parsePlyHeader(bytes, where);
  const PlyElement& vertices = vertexElement(header, where);
  const PlyElement* faces = findElement(header, "face");
  PlyCursor cursor(header.format, header.body, where);
  RawMesh mesh;
  for (const PlyElement& element : header.elements) {
    if (&element == &vertices) {
      mesh.vertices = takeVertices(element, cursor, where);
    } else if (&element == faces) {
      if (mesh.vertices.empty() && element.count > 0) {
        throw Error(where + ": the PLY has faces before or without vertices; reorder it");
      }
      takeFaces(element, cursor, where, mesh);
    } else {
      skipElement(element, cursor);
    }
  }
  return mesh;
}

}  // namespace rangepose
