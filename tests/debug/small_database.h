// A reference object, a scene and search results that are small enough for a test.
#pragma once

#include <cmath>
#include <vector>

#include "debug/scenes.h"
#include "stages/channels_host.h"
#include "stages/reference.h"
#include "stages/scene_channels.h"
#include "stages/search.h"

namespace rangepose::testing {

/// A few views of a box about z, as the database would hold them.
inline ReferenceObject smallObject(int views) {
  ReferenceObject object;
  object.mesh = box(60, 40, 20);
  object.radius_mm = boundingSphere(object.mesh).radius_mm;
  object.diameter_mm = diameter(object.mesh);
  object.size = 32;
  object.edt_passes = 4;
  object.pixel_mm = object.diameter_mm / 28.0;
  const int columns = atlasColumns(views);
  object.atlas = Image<ReferenceTexel>(
      columns * 32, (views + columns - 1) / columns * 32, ReferenceTexel(0.0f));
  for (int i = 0; i < views; ++i) {
    ReferenceView view;
    view.rotation = rotationFromVector({0.4 * i, 0.0, 0.0});
    Camera camera;
    camera.width = camera.height = 32;
    camera.cx = camera.cy = 15.5;
    camera.orthographic = true;
    camera.pixel_size_mm = object.pixel_mm;
    Pose pose{view.rotation, {0.0, 0.0, 32.0 * object.pixel_mm}};
    const Image<SurfaceTexel> seen =
        host::renderSurface(object.mesh, camera, pose, {0, 0, 32, 32, 1});
    const glm::ivec2 origin(i % columns * 32, i / columns * 32);
    for (int y = 0; y < 32; ++y) {
      for (int x = 0; x < 32; ++x) {
        const SurfaceTexel& texel = seen.at(x, y);
        if (texel.w <= 0.0f) continue;
        const float range = texel.w / static_cast<float>(object.pixel_mm);
        object.atlas.at(origin.x + x, origin.y + y) = {2.0f, range, 0.0f, std::abs(texel.z)};
        view.area_px += 1.0f;
      }
    }
    object.views.push_back(view);
  }
  return object;
}

inline SceneChannels smallScene(int width, int height) {
  Image<float> range(width, height, 0.0f);
  for (int y = height / 4; y < 3 * height / 4; ++y) {
    for (int x = width / 4; x < 3 * width / 4; ++x)
      range.at(x, y) = 100.0f + 0.1f * static_cast<float>(x);
  }
  OrthoCamera camera;
  camera.width = width;
  camera.height = height;
  camera.pixel_mm = 2.5;
  ChannelOptions options;
  options.image_width_px = 32;
  options.edt_passes = 4;
  return host::channels(camera, range, options);
}

inline std::vector<Hypothesis> someHypotheses(int views, int windows) {
  std::vector<Hypothesis> result;
  for (int w = 0; w < windows; ++w) {
    for (int v = 0; v < views; ++v) {
      Hypothesis hypothesis;
      hypothesis.view = v;
      hypothesis.window = w;
      hypothesis.translation_px = {1.0f, -2.0f, 100.0f};
      hypothesis.error =
          v == 1 ? kWorstError : 1.0f + 0.1f * static_cast<float>((v * 7 + w) % views);
      result.push_back(hypothesis);
    }
  }
  return result;
}

}  // namespace rangepose::testing
