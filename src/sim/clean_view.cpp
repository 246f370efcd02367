#include "sim/clean_view.h"

#include <algorithm>

namespace rangepose {
namespace {

/// The table as if nothing lay on it; 0 where a ray passes it by.
SurfaceTexel tableAt(
    const Camera& camera, const Pose& camera_from_world, double table_z_mm, int u, int v) {
  const glm::dvec3 up = camera_from_world.rotation[2];
  const glm::dvec3 on_table = camera_from_world * glm::dvec3(0.0, 0.0, table_z_mm);
  // The ray is start + z * along.
  const glm::dvec3 start = camera.unproject(u, v, 0.0);
  const glm::dvec3 along = camera.unproject(u, v, 1.0) - start;
  const double slope = glm::dot(up, along);
  const double z = glm::dot(up, on_table - start) / slope;
  if (!(slope < 0.0) || !(z > 0.0)) return SurfaceTexel(0.0f);
  return SurfaceTexel(glm::vec3(up), static_cast<float>(z));
}

/// The window that a mesh can be seen in, all of the image where it comes near the camera.
SurfaceWindow windowOf(const Mesh& mesh, const Camera& camera, const Pose& camera_from_object) {
  const int all = std::max(camera.width, camera.height);
  const Sphere sphere = boundingSphere(mesh);
  const glm::dvec3 center = camera_from_object * sphere.center_mm;
  if (!camera.orthographic && center.z <= sphere.radius_mm) {
    return {0, 0, camera.width, camera.height, 1};
  }
  return windowAround(camera, center, sphere.radius_mm, all);
}

/// Calls put(x, y, texel) for the pixels that show the mesh when it is alone.
template <typename Put>
void render(const Mesh& mesh,
            const Camera& camera,
            const Pose& camera_from_object,
            const SurfaceWindow& window,
            const Put& put) {
  const Image<SurfaceTexel> seen = host::renderSurface(mesh, camera, camera_from_object, window);
  for (int y = 0; y < window.height; ++y) {
    for (int x = 0; x < window.width; ++x) {
      const SurfaceTexel& texel = seen.at(x, y);
      const int u = window.x0 + x;
      const int v = window.y0 + y;
      if (texel.w > 0.0f && u >= 0 && v >= 0 && u < camera.width && v < camera.height) {
        put(u, v, texel);
      }
    }
  }
}

bool isNearer(const SurfaceTexel& texel, const SurfaceTexel& nearest) {
  return nearest.w == 0.0f || texel.w < nearest.w;
}

void renderFixed(const Mesh& mesh, const Pose& camera_from_world, CleanView& view) {
  const SurfaceWindow window = windowOf(mesh, view.camera, camera_from_world);
  render(mesh, view.camera, camera_from_world, window, [&](int u, int v, const SurfaceTexel& t) {
    SurfaceTexel& nearest = view.surface.at(u, v);
    if (isNearer(t, nearest)) nearest = t;
  });
}

void renderPart(const Mesh& mesh, std::size_t index, const Pose& pose, CleanView& view) {
  Silhouette& silhouette = view.silhouettes[index];
  silhouette.window = windowOf(mesh, view.camera, pose);
  silhouette.covered = Image<std::uint8_t>(silhouette.window.width, silhouette.window.height);
  PixelBox& box = silhouette.box;
  render(mesh, view.camera, pose, silhouette.window, [&](int u, int v, const SurfaceTexel& texel) {
    const bool first = view.silhouette_px[index] == 0;
    box = first ? PixelBox{u, v, u + 1, v + 1}
                : PixelBox{std::min(box.x0, u),
                           std::min(box.y0, v),
                           std::max(box.x1, u + 1),
                           std::max(box.y1, v + 1)};
    ++view.silhouette_px[index];
    silhouette.covered.at(u - silhouette.window.x0, v - silhouette.window.y0) = 1;
    SurfaceTexel& nearest = view.surface.at(u, v);
    if (!isNearer(texel, nearest)) return;
    nearest = texel;
    view.part.at(u, v) = static_cast<std::int16_t>(index);
  });
}

/// Marks pixels where faces of a part are what is seen of the scene.
void renderShiny(const Mesh& faces, std::size_t index, const Pose& pose, CleanView& view) {
  if (faces.triangles.empty()) return;
  const SurfaceWindow window = windowOf(faces, view.camera, pose);
  render(faces, view.camera, pose, window, [&](int u, int v, const SurfaceTexel& texel) {
    constexpr float kSameMm = 0.01f;
    const bool seen = view.part.at(u, v) == static_cast<std::int16_t>(index) &&
                      texel.w <= view.surface.at(u, v).w + kSameMm;
    if (seen) view.shiny.at(u, v) = 1;
  });
}

}  // namespace

Camera padded(const Camera& camera, int margin_px) {
  Camera wide = camera;
  wide.width += 2 * margin_px;
  wide.height += 2 * margin_px;
  wide.cx += margin_px;
  wide.cy += margin_px;
  return wide;
}

CleanView renderHeap(const std::vector<Mesh>& meshes,
                     const std::vector<PlacedPart>& heap,
                     const Camera& camera,
                     const Pose& camera_from_world,
                     const Surroundings& surroundings,
                     const std::vector<Mesh>& shiny) {
  CleanView view;
  view.camera = camera;
  view.surface = Image<SurfaceTexel>(camera.width, camera.height);
  view.part = Image<std::int16_t>(camera.width, camera.height, std::int16_t{-1});
  view.shiny = Image<std::uint8_t>(camera.width, camera.height);
  view.silhouette_px.assign(heap.size(), 0);
  view.silhouettes.resize(heap.size());
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      view.surface.at(u, v) = tableAt(camera, camera_from_world, surroundings.table_z_mm, u, v);
    }
  }
  if (!surroundings.fixed.triangles.empty()) {
    renderFixed(surroundings.fixed, camera_from_world, view);
  }
  for (std::size_t k = 0; k < heap.size(); ++k) {
    const Mesh& mesh = meshes.at(static_cast<std::size_t>(heap[k].mesh));
    renderPart(mesh, k, camera_from_world * heap[k].world_from_object, view);
  }
  for (std::size_t k = 0; k < heap.size() && !shiny.empty(); ++k) {
    const Mesh& faces = shiny.at(static_cast<std::size_t>(heap[k].mesh));
    renderShiny(faces, k, camera_from_world * heap[k].world_from_object, view);
  }
  return view;
}

}  // namespace rangepose
