// Reference views on the host: every later comparison is against these images (paper Sect. 4.1).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "stages/channels_host.h"
#include "stages/reference_host.h"
#include "support/box_mesh.h"
#include "support/shapes.h"
#include "support/tolerances.h"

namespace rangepose {
namespace {

ReferenceTexel texelAt(const ReferenceObject& object, int view, int u, int v) {
  const glm::ivec2 origin = object.tileOrigin(view);
  return object.atlas.at(origin.x + u, origin.y + v);
}

TEST(ReferenceTest, ASphereHasTheSameFormulaInEveryView) {
  ReferenceObject object = test::objectOf(test::bracketBoxes(), 10, 64, 2);
  object.center_mm = {100.0, -50.0, 7.0};
  object.radius_mm = 20.0;
  object.pixel_mm = 40.0 / 60.0;
  object.mesh = test::sphereMesh(object.center_mm, object.radius_mm, 200);
  host::renderReferences(object, {}, {});
  EXPECT_EQ(object.columns(), 4) << "the smallest square that holds 10 tiles";
  EXPECT_EQ(object.atlas.height(), 3 * 64);
  for (int view = 0; view < 10; ++view) {
    for (int v = 0; v < 64; ++v) {
      for (int u = 0; u < 64; ++u) {
        const double reach = std::hypot(u - 31.5, v - 31.5);
        const ReferenceTexel texel = texelAt(object, view, u, v);
        if (reach > 30.0) {
          ASSERT_EQ(texel.g, 0.0f) << view << ": " << u << ", " << v;
          ASSERT_EQ(texel.a, 0.0f);
          ASSERT_LT(texel.r, 0.0f);
        }
        if (reach > 28.0) continue;
        const double height = std::sqrt(900.0 - reach * reach);
        ASSERT_NEAR(texel.g, 64.0 - height, 0.02) << view << ": " << u << ", " << v;
        ASSERT_NEAR(texel.a, height / 30.0, 0.02) << view << ": " << u << ", " << v;
      }
    }
    const ReferenceView& info = object.views[static_cast<std::size_t>(view)];
    EXPECT_NEAR(info.area_px, 3.14159 * 900.0, 60.0);
    EXPECT_EQ(info.box, (PixelBox{2, 2, 62, 62}));
  }
}

TEST(ReferenceTest, ABracketIsWhereTheRaysHitIt) {
  const std::vector<test::Box> boxes = test::bracketBoxes();
  ReferenceObject object = test::objectOf(boxes, 12, 48, 11);
  host::renderReferences(object, {}, {});
  int compared = 0;
  for (int view = 0; view < 12; ++view) {
    const glm::dmat3 object_from_view =
        glm::transpose(object.views[static_cast<std::size_t>(view)].rotation);
    const auto hitAt = [&](double u, double v) {
      const glm::dvec3 start = glm::dvec3(u - 23.5, v - 23.5, -48.0) * object.pixel_mm;
      return test::hitBoxes(
          boxes, object_from_view * start + object.center_mm, object_from_view[2]);
    };
    for (int v = 0; v < 48; ++v) {
      for (int u = 0; u < 48; ++u) {
        const test::Hit hit = hitAt(u, v);
        if (hitAt(u - 0.01, v - 0.01).face != hit.face ||
            hitAt(u + 0.01, v + 0.01).face != hit.face ||
            hitAt(u - 0.01, v + 0.01).face != hit.face ||
            hitAt(u + 0.01, v - 0.01).face != hit.face) {
          continue;
        }
        const ReferenceTexel texel = texelAt(object, view, u, v);
        ASSERT_EQ(texel.g > 0.0f, !std::isinf(hit.distance)) << view << ": " << u << ", " << v;
        if (texel.g == 0.0f) continue;
        ASSERT_NEAR(texel.a, hit.cosine, test::kReferenceCosine);
        ASSERT_NEAR(texel.g, hit.distance / object.pixel_mm, 1e-4 / hit.cosine);
        ++compared;
      }
    }
  }
  EXPECT_GT(compared, 3000);
}

TEST(ReferenceTest, EdgesAndDistancesAreThoseOfTheSceneStages) {
  ReferenceObject object = test::objectOf(test::bracketBoxes(), 7, 40, 5);
  ChannelOptions options;
  options.image_width_px = 40;
  options.edt_passes = 5;
  host::renderReferences(object, options, {});
  EXPECT_EQ(object.edt_passes, 5);
  for (int view = 0; view < 7; ++view) {
    Image<float> range(40, 40);
    for (int i = 0; i < 1600; ++i)
      range.at(i % 40, i / 40) = texelAt(object, view, i % 40, i / 40).g;
    const Image<float> edges = host::edges(range, options.edgeThresholdPx());
    const Image<float> distance = host::distance(range, edges, 5);
    for (int i = 0; i < 1600; ++i) {
      ASSERT_EQ(texelAt(object, view, i % 40, i / 40).b, edges.at(i % 40, i / 40));
      ASSERT_EQ(texelAt(object, view, i % 40, i / 40).r, distance.at(i % 40, i / 40));
    }
  }
}

TEST(ReferenceTest, APlateSeenAtASlantHasAnInside) {
  // Views without one are worth nothing to the search: such plates would never be found.
  ReferenceObject object = test::objectOf({{{-30.0, -20.0, -1.0}, {30.0, 20.0, 1.0}}}, 200, 64, 7);
  host::renderReferences(object, {}, {});
  int seen_at_a_slant = 0;
  for (int view = 0; view < 200; ++view) {
    const double across = object.views[static_cast<std::size_t>(view)].rotation[2].z;
    if (std::abs(across) < 0.35 || std::abs(across) > 0.5) continue;  // 60 to 70 degrees
    ++seen_at_a_slant;
    int inside = 0;
    for (int i = 0; i < 64 * 64; ++i)
      inside += texelAt(object, view, i % 64, i / 64).r > 0.0f ? 1 : 0;
    EXPECT_GT(inside, object.views[static_cast<std::size_t>(view)].area_px / 3) << "view " << view;
  }
  EXPECT_GT(seen_at_a_slant, 10);
}

TEST(ReferenceTest, BoxAreaAndAnchorDescribeTheTile) {
  ReferenceObject object = test::objectOf(test::bracketBoxes(), 10, 64, 3);
  host::renderReferences(object, {}, {});
  for (int view = 0; view < 10; ++view) {
    const ReferenceView& info = object.views[static_cast<std::size_t>(view)];
    int area = 0;
    float most_inner = -100.0f;
    PixelBox box{64, 64, 0, 0};
    for (int v = 0; v < 64; ++v) {
      for (int u = 0; u < 64; ++u) {
        const ReferenceTexel texel = texelAt(object, view, u, v);
        if (texel.g == 0.0f) continue;
        ++area;
        most_inner = std::max(most_inner, texel.r);
        box = {std::min(box.x0, u),
               std::min(box.y0, v),
               std::max(box.x1, u + 1),
               std::max(box.y1, v + 1)};
      }
    }
    EXPECT_EQ(info.area_px, static_cast<float>(area));
    EXPECT_EQ(info.box, box);
    const ReferenceTexel anchor = texelAt(
        object, view, static_cast<int>(info.anchor_px.x), static_cast<int>(info.anchor_px.y));
    EXPECT_EQ(anchor.r, most_inner);
    EXPECT_EQ(anchor.g, info.anchor_px.z);
    EXPECT_LE(info.area_px, object.maxArea());
  }
}

TEST(ReferenceTest, AnEmptyTileHasNoBox) {
  ReferenceObject object = test::objectOf(test::bracketBoxes(), 1, 64, 3);
  object.atlas = Image<ReferenceTexel>(64, 64, ReferenceTexel(0.0f));
  object.views[0].area_px = 7.0f;
  describeTile(object, 0);
  EXPECT_TRUE(object.views[0].box.empty());
  EXPECT_EQ(object.views[0].area_px, 0.0f);
}

TEST(ReferenceTest, TheNumberOfThreadsChangesNothing) {
  ReferenceObject one = test::objectOf(test::bracketBoxes(), 100, 32, 9);
  ReferenceObject four = one;
  setThreadCount(1);
  host::renderReferences(one, {}, {});
  setThreadCount(4);
  host::renderReferences(four, {}, {});
  setThreadCount(0);
  EXPECT_EQ(one.atlas, four.atlas);
  for (std::size_t i = 0; i < one.views.size(); ++i) {
    EXPECT_EQ(one.views[i].box, four.views[i].box);
    EXPECT_EQ(one.views[i].anchor_px, four.views[i].anchor_px);
  }
}

TEST(ReferenceTest, ProgressRisesToTheEnd) {
  ReferenceObject object = test::objectOf(test::bracketBoxes(), 50, 32, 9);
  std::vector<int> done;
  host::renderReferences(object, {}, [&](int ready, int total) {
    EXPECT_EQ(total, 50);
    done.push_back(ready);
  });
  EXPECT_GT(done.size(), 1U);
  EXPECT_TRUE(std::is_sorted(done.begin(), done.end()));
  EXPECT_EQ(done.back(), 50);
}

TEST(ReferenceTest, AtlasColumnsHoldAllTiles) {
  for (const int views : {1, 2, 4, 5, 1023, 1024, 1025, 65536}) {
    const int columns = atlasColumns(views);
    EXPECT_GE(columns * columns, views);
    EXPECT_LT((columns - 1) * (columns - 1), views);
  }
}

}  // namespace
}  // namespace rangepose
