// The database file: read back as written, or refused. A wrong database would send a robot to wrong
// places.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "core/error.h"
#include "database/reference_database.h"
#include "geometry/orientation_grid.h"
#include "stages/reference_host.h"
#include "stages/search_host.h"
#include "support/box_mesh.h"
#include "support/range_scenes.h"
#include "support/shapes.h"
#include "support/temp_folder.h"

namespace rangepose {
namespace {

using testing::AllOf;
using testing::HasSubstr;

ReferenceObject rendered(const Mesh& mesh, int id, int size, int views) {
  const ChannelOptions options = channelOptionsFor(size);
  ReferenceObject object = describeObject(mesh, id, size, uniformRotations(views), options);
  host::renderReferences(object, options, {});
  return object;
}

ReferenceDatabase smallDatabase() {
  ReferenceDatabase database;
  database.objects.push_back(rendered(test::meshOf(test::bracketBoxes()), 3, 16, 5));
  database.objects.push_back(rendered(test::plateMesh(30.0, 20.0), 7, 24, 2));
  Symmetries& symmetries = database.objects[1].symmetries;
  symmetries.discrete.push_back({rotationFromVector({0.0, 0.0, 3.0}), {1.0, 2.0, 3.0}});
  symmetries.discrete.push_back({rotationFromVector({0.5, 0.0, 0.0}), {4.0, 5.0, 6.0}});
  symmetries.continuous.push_back({{0.0, 1.0, 0.0}, {7.0, 8.0, 9.0}});
  database.objects[0].twins.push_back({rotationFromVector({3.1, 0.0, 0.0}), {1.5, 2.5, 3.5}});
  return database;
}

/// "accepted", or the message of the error.
std::string messageFor(const std::vector<char>& bytes) {
  try {
    deserialize(bytes, "parts.rpdb");
  } catch (const Error& error) {
    return error.what();
  }
  return "accepted";
}

void expectSamePoses(const std::vector<Pose>& actual, const std::vector<Pose>& expected) {
  ASSERT_EQ(actual.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(actual[i].rotation, expected[i].rotation);
    EXPECT_EQ(actual[i].translation_mm, expected[i].translation_mm);
  }
}

void expectSameObject(const ReferenceObject& actual, const ReferenceObject& expected) {
  EXPECT_EQ(actual.id, expected.id);
  EXPECT_EQ(actual.mesh.name, expected.mesh.name);
  EXPECT_EQ(actual.mesh.vertices, expected.mesh.vertices);
  EXPECT_EQ(actual.mesh.triangles, expected.mesh.triangles);
  expectSamePoses(actual.symmetries.discrete, expected.symmetries.discrete);
  expectSamePoses(actual.twins, expected.twins);
  ASSERT_EQ(actual.symmetries.continuous.size(), expected.symmetries.continuous.size());
  for (std::size_t i = 0; i < expected.symmetries.continuous.size(); ++i) {
    EXPECT_EQ(actual.symmetries.continuous[i].direction,
              expected.symmetries.continuous[i].direction);
    EXPECT_EQ(actual.symmetries.continuous[i].point_mm, expected.symmetries.continuous[i].point_mm);
  }
  EXPECT_EQ(actual.center_mm, expected.center_mm);
  EXPECT_EQ(actual.radius_mm, expected.radius_mm);
  EXPECT_EQ(actual.diameter_mm, expected.diameter_mm);
  EXPECT_EQ(actual.pixel_mm, expected.pixel_mm);
  EXPECT_EQ(actual.size, expected.size);
  EXPECT_EQ(actual.edt_passes, expected.edt_passes);
  ASSERT_EQ(actual.views.size(), expected.views.size());
  ASSERT_EQ(actual.columns(), expected.columns());
  for (int i = 0; i < static_cast<int>(expected.views.size()); ++i) {
    const ReferenceView& view = expected.views[static_cast<std::size_t>(i)];
    const ReferenceView& back = actual.views[static_cast<std::size_t>(i)];
    EXPECT_EQ(back.rotation, view.rotation);
    EXPECT_EQ(back.box, view.box);
    EXPECT_EQ(back.area_px, view.area_px);
    EXPECT_EQ(back.anchor_px, view.anchor_px);
    const glm::ivec2 origin = expected.tileOrigin(i);
    for (int v = 0; v < expected.size; ++v) {
      for (int u = 0; u < expected.size; ++u) {
        const bool kept =
            u >= view.box.x0 && u < view.box.x1 && v >= view.box.y0 && v < view.box.y1;
        const ReferenceTexel& texel = actual.atlas.at(origin.x + u, origin.y + v);
        ASSERT_EQ(texel,
                  kept ? expected.atlas.at(origin.x + u, origin.y + v) : ReferenceTexel(0.0f))
            << "view " << i << ": " << u << ", " << v;
      }
    }
  }
}

TEST(DatabaseFileTest, ComesBackAsItWasWritten) {
  const ReferenceDatabase database = smallDatabase();
  const std::vector<char> bytes = serialize(database);
  const ReferenceDatabase back = deserialize(bytes, "parts.rpdb");
  ASSERT_EQ(back.objects.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) expectSameObject(back.objects[i], database.objects[i]);
  EXPECT_EQ(serialize(back), bytes) << "a database that was read and written again is another one";
}

TEST(DatabaseFileTest, SearchesLikeTheOneInMemory) {
  const ReferenceObject object = rendered(test::meshOf(test::bracketBoxes()), 1, 32, 40);
  ReferenceDatabase database;
  database.objects.push_back(object);
  const ReferenceDatabase back = deserialize(serialize(database), "parts.rpdb");
  SceneChannels window;
  window.range_px = test::randomBlobs(64, 64, 2);
  window.distance_px = test::randomBlobs(64, 64, 3);
  const std::vector<glm::vec3> at(40, {2.0f, -1.0f, 90.0f});
  const auto expected = host::errorTerms(object, host::PackedViews(object), window, at, {});
  const auto actual =
      host::errorTerms(back.objects[0], host::PackedViews(back.objects[0]), window, at, {});
  for (std::size_t i = 0; i < 40; ++i) {
    EXPECT_EQ(actual[i].cover_sum, expected[i].cover_sum);
    EXPECT_EQ(actual[i].range_sum, expected[i].range_sum);
  }
}

TEST(DatabaseFileTest, EveryTruncationIsRefused) {
  const std::vector<char> bytes = serialize(smallDatabase());
  test::Random random(1);
  std::vector<std::size_t> lengths;
  for (std::size_t length = 0; length < 200; ++length) lengths.push_back(length);
  for (int i = 0; i < 400; ++i) {
    lengths.push_back(static_cast<std::size_t>(random.index(static_cast<int>(bytes.size()))));
  }
  lengths.push_back(bytes.size() - 1);
  for (const std::size_t length : lengths) {
    // A copy of just these bytes, so that a sanitizer sees any read past the end.
    const std::vector<char> head(bytes.begin(),
                                 bytes.begin() + static_cast<std::ptrdiff_t>(length));
    const std::string message = messageFor(head);
    ASSERT_NE(message, "accepted") << length << " of " << bytes.size() << " bytes";
    ASSERT_THAT(message, HasSubstr("parts.rpdb")) << length;
  }
  EXPECT_THAT(messageFor({bytes.begin(), bytes.end() - 100}), HasSubstr("truncated"));
}

TEST(DatabaseFileTest, EveryDamagedByteIsRefused) {
  const std::vector<char> bytes = serialize(smallDatabase());
  test::Random random(2);
  for (int i = 0; i < 1500; ++i) {
    const std::size_t at =
        i < 64 ? static_cast<std::size_t>(i)
               : static_cast<std::size_t>(random.index(static_cast<int>(bytes.size())));
    std::vector<char> damaged = bytes;
    damaged[at] = static_cast<char>(damaged[at] ^ (1 << random.index(8)));
    ASSERT_NE(messageFor(damaged), "accepted") << "byte " << at;
  }
  std::vector<char> damaged = bytes;
  damaged[bytes.size() / 2] = static_cast<char>(damaged[bytes.size() / 2] + 1);
  EXPECT_THAT(messageFor(damaged),
              AllOf(HasSubstr("damaged"), HasSubstr("build the database again")));
  damaged = bytes;
  damaged.push_back('x');
  EXPECT_THAT(messageFor(damaged), HasSubstr("after the end"));
}

TEST(DatabaseFileTest, OtherFilesAndVersionsAreTold) {
  EXPECT_THAT(messageFor({}), HasSubstr("not a rangepose database"));
  EXPECT_THAT(messageFor({'p', 'l', 'y', '\n', 'f', 'o', 'r', 'm'}),
              HasSubstr("not a rangepose database"));
  std::vector<char> newer = serialize(smallDatabase());
  newer[4] = static_cast<char>(newer[4] + 1);
  EXPECT_THAT(messageFor(newer), AllOf(HasSubstr("version 5"), HasSubstr("reads version 4")));
}

TEST(DatabaseFileTest, ADatabaseWithoutObjectsIsRefused) {
  EXPECT_THAT(messageFor(serialize({})), HasSubstr("without objects"));
}

TEST(DatabaseFileTest, ImpossibleSizesAreRefusedBeforeTheyAreUsed) {
  // Well-formed files, checksum included, of objects that no builder makes.
  const auto spoiled = [](const auto& change) {
    ReferenceDatabase database = smallDatabase();
    change(database.objects[1]);
    return messageFor(serialize(database));
  };
  EXPECT_THAT(spoiled([](ReferenceObject& o) { o.pixel_mm = 0.0; }), HasSubstr("object 7"));
  EXPECT_THAT(spoiled([](ReferenceObject& o) { o.radius_mm = std::nan(""); }),
              HasSubstr("object 7"));
  EXPECT_THAT(spoiled([](ReferenceObject& o) { o.edt_passes = 0; }), HasSubstr("object 7"));
  EXPECT_THAT(spoiled([](ReferenceObject& o) { o.views.clear(); }), HasSubstr("views"));
  EXPECT_THAT(spoiled([](ReferenceObject& o) {
                o.views[1].box = {5, 5, 5, 3};
              }),
              HasSubstr("view 1"));
  EXPECT_THAT(spoiled([](ReferenceObject& o) { o.symmetries.continuous[0].point_mm.y = NAN; }),
              HasSubstr("symmetries"));
  EXPECT_THAT(
      spoiled([](ReferenceObject& o) { o.symmetries.discrete[1].rotation[2].x = INFINITY; }),
      HasSubstr("symmetries"));
  EXPECT_THAT(spoiled([](ReferenceObject& o) { o.mesh.triangles[0].x = 99; }), HasSubstr("face 0"));
}

class DatabasePathTest : public testing::Test {
 protected:
  const std::filesystem::path& folder() const { return folder_.path(); }

 private:
  const test::TempFolder folder_;
};

TEST_F(DatabasePathTest, ReadsAFile) {
  const ReferenceDatabase database = smallDatabase();
  const std::vector<char> bytes = serialize(database);
  const std::filesystem::path path = folder() / "parts.rpdb";
  std::ofstream(path, std::ios::binary)
      .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  EXPECT_EQ(serialize(readDatabase(path)), bytes);
}

TEST_F(DatabasePathTest, AMissingFileAFolderAndAnEmptyFileAreNamed) {
  std::ofstream(folder() / "empty.rpdb").flush();
  for (const std::filesystem::path& path :
       {folder() / "missing.rpdb", folder(), folder() / "empty.rpdb"}) {
    try {
      readDatabase(path);
      ADD_FAILURE() << path << " was read";
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), HasSubstr(path.string()));
      EXPECT_THAT(error.what(), HasSubstr("rangepose build")) << "no word on what to do";
    }
  }
}

}  // namespace
}  // namespace rangepose
