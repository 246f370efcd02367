#include "gles/references_gles.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/parallel.h"
#include "gles/device.h"
#include "gles/mesh_buffers.h"
#include "stages/reference_host.h"

namespace rangepose::gles {
namespace {

/// Texels of a target that is drawn at once: large enough to fill a GPU, small enough for its
/// caches.
constexpr int kTexelsPerBatch = 1 << 20;
/// Triangles of one draw call, so that no call keeps a shared GPU from its other users for long.
constexpr int kTrianglesPerDraw = 4'000'000;
constexpr int kViewsPerPiece = 16;

/// Rows of the transform from mesh buffers to (column, row) in the target and range [px].
struct ViewTransform {
  glm::vec4 to_column;
  glm::vec4 to_row;
  glm::vec4 to_range;
};

void checkObject(const ReferenceObject& object) {
  const std::string where = "references of object " + std::to_string(object.id) + ": ";
  RP_CHECK(!object.views.empty(), where + "no views");
  RP_CHECK(object.size >= 8, where + "tiles need 8 px at least");
  RP_CHECK(std::isfinite(object.pixel_mm) && object.pixel_mm > 0.0,
           where + "pixel_mm must be positive");
  RP_CHECK(object.radius_mm <= 0.5 * object.size * object.pixel_mm,
           where + "the bounding sphere does not fit into a tile; raise pixel_mm");
}

ViewTransform transformOf(const ReferenceObject& object,
                          int view,
                          const glm::dvec3& origin_mm,
                          const glm::ivec2& tile) {
  const glm::dmat3& rotation = object.views[static_cast<std::size_t>(view)].rotation;
  const glm::dvec3 shift = rotation * (origin_mm - object.center_mm) / object.pixel_mm;
  const double half = 0.5 * object.size;
  const glm::dvec3 offset = shift + glm::dvec3(tile.x + half, tile.y + half, object.size);
  const auto row = [&](int r) {
    return glm::vec4(rotation[0][r] / object.pixel_mm,
                     rotation[1][r] / object.pixel_mm,
                     rotation[2][r] / object.pixel_mm,
                     offset[r]);
  };
  return {row(0), row(1), row(2)};
}

/// Box in the target that holds all texels of the view which differ from an empty tile: the object
/// and the background that its edges reach in `passes` passes.
PixelBox reachOf(const Mesh& mesh,
                 const glm::dvec3& origin_mm,
                 const ViewTransform& view,
                 const PixelBox& tile,
                 int passes) {
  glm::vec2 low(std::numeric_limits<float>::max());
  glm::vec2 high(std::numeric_limits<float>::lowest());
  for (const glm::vec3& vertex : mesh.vertices) {
    const glm::vec4 point(vertex - glm::vec3(origin_mm), 1.0f);
    const glm::vec2 at(glm::dot(view.to_column, point), glm::dot(view.to_row, point));
    low = glm::min(low, at);
    high = glm::max(high, at);
  }
  const int margin = passes + 1;
  return {std::max(tile.x0, static_cast<int>(std::floor(low.x)) - margin),
          std::max(tile.y0, static_cast<int>(std::floor(low.y)) - margin),
          std::min(tile.x1, static_cast<int>(std::ceil(high.x)) + margin),
          std::min(tile.y1, static_cast<int>(std::ceil(high.y)) + margin)};
}

/// Renders views [first, first + count) of an object into a target of whole rows of tiles.
class BatchRenderer {
 public:
  BatchRenderer(Context& context,
                const ReferenceObject& object,
                const ChannelOptions& options,
                int columns,
                int rows)
      : device_(context),
        object_(object),
        options_(options),
        columns_(columns),
        size_(columns * object.size, rows * object.size),
        mesh_(object.mesh),
        surface_(Format::kRgba32f, size_.x, size_.y),
        depth_(Format::kDepth32f, size_.x, size_.y),
        surface_target_(surface_.texture, &depth_),
        edges_(Format::kR32f, size_.x, size_.y),
        distances_{{{Format::kRgba32f, size_.x, size_.y}, {Format::kRgba32f, size_.x, size_.y}}} {}

  /// Writes the texels of `rows` rows of tiles.
  void render(int first, int count, int rows, float* texels) {
    place(first, count);
    drawSurfaces();
    const Regions regions(regions_);
    drawChannels(regions);
    result().downloadRgba(0, rows * object_.size, texels);
  }

 private:
  using CanvasPair = std::array<Canvas, 2>;
  const Texture& result() const { return distances_[1].texture; }

  void place(int first, int count) {
    transforms_.resize(static_cast<std::size_t>(count));
    regions_.resize(static_cast<std::size_t>(count));
    parallelFor(count, kViewsPerPiece, [&](int begin, int end) {
      for (int i = begin; i < end; ++i) {
        const std::size_t at = static_cast<std::size_t>(i);
        const glm::ivec2 tile = glm::ivec2(i % columns_, i / columns_) * object_.size;
        transforms_[at] = transformOf(object_, first + i, mesh_.center_mm(), tile);
        const PixelBox box = {tile.x, tile.y, tile.x + object_.size, tile.y + object_.size};
        const PixelBox reach =
            reachOf(object_.mesh, mesh_.center_mm(), transforms_[at], box, options_.edt_passes);
        regions_[at] = {reach, reach};
      }
    });
  }

  void drawSurfaces() {
    surface_target_.clear(glm::vec4(0.0f));
    surface_target_.clearDepth();
    const int triangles = std::max(1, mesh_.corners() / 3);
    const std::size_t per_draw =
        static_cast<std::size_t>(std::max(1, kTrianglesPerDraw / triangles));
    for (std::size_t first = 0; first < transforms_.size(); first += per_draw) {
      const std::size_t count = std::min(per_draw, transforms_.size() - first);
      const Buffer instances(transforms_.data() + first, count * sizeof(ViewTransform));
      VertexArray vertices;
      mesh_.addTo(vertices);
      constexpr int kStride = sizeof(ViewTransform);
      vertices.add(instances, {2, 4, false, kStride, offsetof(ViewTransform, to_column), true});
      vertices.add(instances, {3, 4, false, kStride, offsetof(ViewTransform, to_row), true});
      vertices.add(instances, {4, 4, false, kStride, offsetof(ViewTransform, to_range), true});
      Pass(device_, ProgramId::kReferenceView, surface_target_)
          .set("u_target_size", glm::vec2(size_))
          .set("u_size", static_cast<float>(object_.size))
          .depthTest()
          .drawTriangles(vertices, mesh_.corners(), static_cast<int>(count));
    }
  }

  Pass into(const Canvas& target, ProgramId program) {
    Pass pass(device_, program, target.framebuffer);
    pass.set("u_target_size", size_);
    return pass;
  }

  void drawChannels(const Regions& regions) {
    into(edges_, ProgramId::kReferenceEdges)
        .texture("u_range", surface_.texture)
        .set("u_threshold_px", options_.edgeThresholdPx())
        .draw(regions);
    into(distances_[0], ProgramId::kReferenceEdtInit)
        .texture("u_range", surface_.texture)
        .texture("u_edges", edges_.texture)
        .set("u_passes", options_.edt_passes)
        .draw(regions);
    for (int pass = 0; pass < options_.edt_passes; ++pass) {
      into(distances_[1], ProgramId::kEdtStep)
          .texture("u_previous", distances_[0].texture)
          .draw(regions);
      std::swap(distances_[0], distances_[1]);
    }
    const float far = -static_cast<float>(options_.edt_passes + 1);
    distances_[1].framebuffer.clear(glm::vec4(far, 0.0f, 0.0f, 0.0f));
    into(distances_[1], ProgramId::kReferenceTexel)
        .texture("u_surface", surface_.texture)
        .texture("u_edges", edges_.texture)
        .texture("u_distances", distances_[0].texture)
        .draw(regions);
  }

  Device device_;
  const ReferenceObject& object_;
  ChannelOptions options_;
  int columns_;
  glm::ivec2 size_;
  MeshBuffers mesh_;
  Canvas surface_;
  Texture depth_;
  Framebuffer surface_target_;
  Canvas edges_;
  CanvasPair distances_;
  std::vector<ViewTransform> transforms_;
  std::vector<Region> regions_;
};

/// Throws where a view shows nothing.
void describeView(ReferenceObject& object, int view) {
  describeTile(object, view);
  if (object.views[static_cast<std::size_t>(view)].area_px > 0.0f) return;
  throw Error("references of object " + std::to_string(object.id) + ": view " +
              std::to_string(view) + " shows no pixel; the mesh is too thin for this pixel_mm");
}

}  // namespace

void renderReferences(Context& context,
                      ReferenceObject& object,
                      const ChannelOptions& options,
                      const RenderProgress& progress) {
  checkMesh(object.mesh);
  checkObject(object);
  options.check();
  context.makeCurrent();
  const int views = static_cast<int>(object.views.size());
  const int columns = atlasColumns(views);
  const int rows = (views + columns - 1) / columns;
  const int texels_per_row = columns * object.size * object.size;
  const int rows_per_batch = std::clamp(kTexelsPerBatch / texels_per_row, 1, rows);
  object.edt_passes = options.edt_passes;
  object.serial = newReferenceSerial();
  object.atlas = Image<ReferenceTexel>(columns * object.size, rows * object.size);
  BatchRenderer renderer(context, object, options, columns, rows_per_batch);
  for (int row = 0; row < rows; row += rows_per_batch) {
    const int first = row * columns;
    const int batch_rows = std::min(rows_per_batch, rows - row);
    const int count = std::min(batch_rows * columns, views - first);
    renderer.render(first, count, batch_rows, &object.atlas.row(row * object.size)->x);
    if (progress) progress(first + count, views);
  }
  parallelFor(views, kViewsPerPiece, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) describeView(object, i);
  });
}

}  // namespace rangepose::gles
