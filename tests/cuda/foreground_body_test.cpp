// The bodies of the foreground's kernels, run on the host in the order of their launches, against
// the host's stages. Where they differ, a device would search parts in the table, or lose thin ones
// with it.
#include "cuda/foreground_body.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <set>

#include "cuda/extent_body.h"
#include "cuda/foreground_scene.h"
#include "cuda/threaded_block.h"
#include "stages/plane_draws.h"

namespace rangepose {
namespace {

constexpr int kThreads = 64;
constexpr int kParts = 5;
constexpr int kMostRounds = 16;
using Block = cuda::HostBlock<kThreads>;

/// All launches of an image, one after the other.
class Launches {
 public:
  explicit Launches(const test::ForegroundScene& scene)
      : measured(scene.image.depth_mm),
        depth(measured),
        rules(cuda::rulesFor(scene.image.camera, scene.task)) {
    const int most = cuda::mostSamples(measured.width(), measured.height());
    for (int side = 0; side < 2; ++side) {
      values[side].assign(6 * static_cast<std::size_t>(most), -777.0);
      arrays[side] = {values[side].data(), most};
    }
    PlaneDraws random;
    for (int i = 0; i < kMostRounds * cuda::kDrawsOfRound; ++i) draws.push_back(random.next());
  }

  void findNoise() {
    Block block;
    std::vector<std::uint32_t> counts(cuda::kNoiseBins, 0);
    std::uint32_t bins[cuda::kNoiseBins];
    std::uint32_t sums[kThreads];
    std::vector<double> parts(kParts);
    const auto read = [&](int u, int v) { return measured.at(u, v); };
    for (int digit = 0; digit < cuda::kNoiseDigits; ++digit) {
      for (int part = kParts - 1; part >= 0; --part) {
        cuda::countDigits(
            block,
            bins,
            state.noise,
            digit,
            part,
            kParts,
            measured.width(),
            measured.height(),
            read,
            [&](int bin) { ++bins[bin]; },
            [&](int bin, std::uint32_t count) { counts[static_cast<std::size_t>(bin)] += count; });
      }
      cuda::pickDigit(block, sums, state.noise, digit, counts.data());
    }
    EXPECT_EQ(std::count(counts.begin(), counts.end(), 0u), cuda::kNoiseBins)
        << "the next image would start with counts of this one";
    for (int part = 0; part < kParts; ++part) {
      cuda::sumLower(block,
                     state.noise,
                     part,
                     kParts,
                     measured.width(),
                     measured.height(),
                     read,
                     parts[static_cast<std::size_t>(part)]);
    }
    state.noise.noise_mm = cuda::noiseOfParts(state.noise, parts.data(), kParts);
  }

  void fillLost() {
    const auto read = [&](int u, int v) { return measured.at(u, v); };
    for (int v = 0; v < measured.height(); ++v) {
      for (int u = 0; u < measured.width(); ++u) {
        bool lost = false;
        depth.at(u, v) = cuda::filledPixel(rules.camera, read, u, v, state.noise.noise_mm, lost);
        state.measured += measured.at(u, v) > 0.0f ? 1 : 0;
        state.lost += lost ? 1 : 0;
      }
    }
    if (!areMany(state.lost, state.measured)) depth = measured;
  }

  auto around() const {
    return [this](int u, int v) {
      return depth.contains(u, v) ? static_cast<double>(depth.at(u, v)) : 0.0;
    };
  }

  void takeSamples() {
    Block block;
    int first[kThreads];
    cuda::takeSamples(block, first, rules, around(), arrays[0], state);
  }

  int findPlanes() {
    Block block;
    int round = 0;
    for (; round < kMostRounds && state.done == 0; ++round) {
      const std::uint64_t* own = drawsOf(round);
      // In any order: the largest key does not depend on it.
      for (int trial = kPlaneTrials - 1; trial >= 0; --trial) {
        cuda::TrialShared shared{};
        cuda::tryPlane(block, shared, state, rules, arrays, own, trial, [&](auto key) {
          state.best = std::max(state.best, key);
        });
      }
      cuda::RoundShared<kThreads> shared{};
      cuda::settlePlane(block, shared, state, rules, arrays, own);
    }
    return round;
  }

  Image<std::uint8_t> mask() const {
    Image<std::uint8_t> kept(depth.width(), depth.height(), 0);
    for (int v = 0; v < depth.height(); ++v) {
      for (int u = 0; u < depth.width(); ++u) {
        if (cuda::isForeground(state, rules, u, v, depth.at(u, v))) kept.at(u, v) = 1;
      }
    }
    return kept;
  }

  const std::uint64_t* drawsOf(int round) const {
    return draws.data() + static_cast<std::ptrdiff_t>(round) * cuda::kDrawsOfRound;
  }

  Image<float> measured;
  Image<float> depth;
  cuda::ForegroundRules rules;
  cuda::ForegroundState state;
  std::vector<double> values[2];
  cuda::SampleArrays arrays[2];
  std::vector<std::uint64_t> draws;
};

class ForegroundBodyTest : public testing::TestWithParam<int> {
 protected:
  ForegroundBodyTest()
      : scene_(test::foregroundScenes()[static_cast<std::size_t>(GetParam())]),
        expected_(host::foreground(scene_.image, scene_.task)),
        launches_(scene_) {}

  test::ForegroundScene scene_;
  Foreground expected_;
  Launches launches_;
};

TEST_P(ForegroundBodyTest, IsTheHosts) {
  SCOPED_TRACE(scene_.name);
  launches_.findNoise();
  const cuda::ForegroundState& state = launches_.state;
  launches_.fillLost();
  launches_.takeSamples();
  EXPECT_LE(state.samples, launches_.arrays[0].capacity);
  launches_.findPlanes();
  EXPECT_EQ(state.done, 1);
  Foreground actual;
  actual.noise_mm = state.noise.noise_mm;
  actual.depth.depth_mm = launches_.depth;
  actual.background.assign(state.plane, state.plane + state.planes);
  actual.mask = launches_.mask();
  test::expectLike(actual, expected_);
}

TEST_P(ForegroundBodyTest, ExtentIsTheHosts) {
  SCOPED_TRACE(scene_.name);
  std::vector<float> kept(expected_.mask.size());
  for (std::size_t i = 0; i < kept.size(); ++i)
    kept[i] = expected_.mask.data()[i] != 0 ? expected_.depth.depth_mm.data()[i] : 0.0f;
  std::vector<unsigned long long> keys(4, ~0ULL);
  Block block;
  for (int part = 0; part < kParts; ++part) {
    cuda::extentOfPart(block, scene_.image.camera, kept.data(), part, kParts, [&](int k, auto key) {
      auto& least = keys[static_cast<std::size_t>(k)];
      least = std::min(least, key);
    });
  }
  const LateralExtent extent = host::extentOf(expected_.depth, expected_.mask);
  EXPECT_EQ(cuda::valueOfKey(keys[0]), extent.low.x);
  EXPECT_EQ(cuda::valueOfKey(keys[1]), extent.low.y);
  EXPECT_EQ(-cuda::valueOfKey(keys[2]), extent.high.x);
  EXPECT_EQ(-cuda::valueOfKey(keys[3]), extent.high.y);
}

INSTANTIATE_TEST_SUITE_P(Scenes,
                         ForegroundBodyTest,
                         testing::Range(0, static_cast<int>(test::foregroundScenes().size())));

/// The comparisons above are worth what their scenes have in them.
TEST(ForegroundBodySceneTest, ScenesHaveWallsFacesNoiseAndLostPixels) {
  std::set<std::size_t> planes;
  bool filled = false;
  bool holes_stay = false;
  bool faces = false;
  for (const test::ForegroundScene& scene : test::foregroundScenes()) {
    const Foreground found = host::foreground(scene.image, scene.task);
    planes.insert(found.background.size());
    filled = filled || found.depth.depth_mm != scene.image.depth_mm;
    Launches launches(scene);
    launches.findNoise();
    launches.fillLost();
    holes_stay = holes_stay || (launches.state.lost > 0 &&
                                !areMany(launches.state.lost, launches.state.measured));
    launches.takeSamples();
    const int rounds = launches.findPlanes();
    // Each round but the last finds a plane or a face.
    faces = faces || rounds > launches.state.planes + 1;
  }
  EXPECT_TRUE(planes.contains(0) && planes.contains(3)) << "no wall was found, or there always is";
  EXPECT_TRUE(filled && holes_stay && faces) << filled << holes_stay << faces;
}

TEST(ForegroundBodyTest, KeysAreOrderedLikeNumbers) {
  const std::vector<double> numbers{-1e308, -3.5, -1e-300, 0.0, 1e-300, 2.0, 1e308};
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    EXPECT_EQ(cuda::valueOfKey(cuda::orderedKey(numbers[i])), numbers[i]);
    if (i == 0) continue;
    EXPECT_LT(cuda::orderedKey(numbers[i - 1]), cuda::orderedKey(numbers[i]));
  }
  EXPECT_LT(cuda::planeKey(4, 0), cuda::planeKey(5, 3999)) << "more samples win";
  EXPECT_LT(cuda::planeKey(5, 7), cuda::planeKey(5, 6)) << "then the earlier plane";
  EXPECT_EQ(cuda::trialOf(cuda::planeKey(5, 3999)), 3999);
}

/// Images of which all or every n-th pixel of every n-th row was measured.
TEST(ForegroundBodyTest, SamplesFitTheirMemory) {
  for (const auto& [width, height] : {std::pair{640, 480}, {97, 71}, {1920, 1200}}) {
    const int most = cuda::mostSamples(width, height);
    for (int each = 1; each <= 12; ++each) {
      const int measured = ((width + each - 1) / each) * ((height + each - 1) / each);
      const int stride = sampleStride(measured);
      int samples = 0;
      for (int v = 0; v < height; v += stride) {
        if (v % each != 0) continue;
        for (int u = 0; u < width; u += stride) samples += u % each == 0 ? 1 : 0;
      }
      EXPECT_LE(samples, most) << width << "x" << height << ", every " << each;
    }
  }
}

/// By threads that really run side by side.
TEST(ForegroundThreadedTest, NoiseSamplesAndPlanesAreThoseOfOneThread) {
  const test::ForegroundScene scene = test::binScene("small", test::pinholeCamera(160, 120, 210.0));
  Launches one(scene);
  one.findNoise();
  one.fillLost();
  one.takeSamples();
  Launches many(scene);
  many.state = one.state;
  int first[kThreads];
  many.state.samples = -1;
  test::runThreaded<kThreads>([&](auto& block) {
    cuda::takeSamples(block, first, many.rules, many.around(), many.arrays[0], many.state);
  });
  EXPECT_EQ(many.state.samples, one.state.samples);
  EXPECT_EQ(many.values[0], one.values[0]);
  ASSERT_GT(one.state.samples, 1000);
  Block host;
  for (int round = 0; round < 5; ++round) {
    for (int trial = 0; trial < kPlaneTrials; ++trial) {
      cuda::TrialShared shared{};
      cuda::tryPlane(
          host, shared, one.state, one.rules, one.arrays, one.drawsOf(round), trial, [&](auto key) {
            one.state.best = std::max(one.state.best, key);
          });
    }
    if (one.state.done == 0) {
      many.state.best = 0;
      cuda::TrialShared shared{};
      const int trial = cuda::trialOf(one.state.best);
      test::runThreaded<kThreads>([&](auto& block) {
        cuda::tryPlane(block,
                       shared,
                       many.state,
                       many.rules,
                       many.arrays,
                       many.drawsOf(round),
                       trial,
                       [&](auto key) { many.state.best = std::max(many.state.best, key); });
      });
      EXPECT_EQ(many.state.best, one.state.best) << round;
    }
    cuda::RoundShared<kThreads> alone{};
    cuda::settlePlane(host, alone, one.state, one.rules, one.arrays, one.drawsOf(round));
    cuda::RoundShared<kThreads> shared{};
    test::runThreaded<kThreads>([&](auto& block) {
      cuda::settlePlane(block, shared, many.state, many.rules, many.arrays, many.drawsOf(round));
    });
    EXPECT_EQ(many.state.samples, one.state.samples) << round;
    EXPECT_EQ(many.state.planes, one.state.planes) << round;
    EXPECT_EQ(many.state.done, one.state.done) << round;
  }
  EXPECT_GE(one.state.planes, 2);
  for (int i = 0; i < one.state.planes; ++i)
    EXPECT_EQ(many.state.plane[i].offset_mm, one.state.plane[i].offset_mm);
}

TEST(ForegroundThreadedTest, TheMiddleDifferenceIsThatOfOneThread) {
  test::ForegroundScene scene = test::binScene("small", test::pinholeCamera(160, 120, 210.0));
  test::addNoise(scene.image, 0.4, 0.02, 0.0);
  Launches launches(scene);
  launches.findNoise();
  const auto read = [&](int u, int v) { return launches.measured.at(u, v); };
  cuda::NoiseState state;
  std::vector<std::uint32_t> counts(cuda::kNoiseBins, 0);
  std::uint32_t bins[cuda::kNoiseBins];
  std::uint32_t sums[kThreads];
  for (int digit = 0; digit < cuda::kNoiseDigits; ++digit) {
    test::runThreaded<kThreads>([&](auto& block) {
      cuda::countDigits(
          block,
          bins,
          state,
          digit,
          0,
          1,
          160,
          120,
          read,
          [&](int bin) { std::atomic_ref(bins[bin]).fetch_add(1); },
          [&](int bin, std::uint32_t count) { counts[static_cast<std::size_t>(bin)] += count; });
    });
    test::runThreaded<kThreads>(
        [&](auto& block) { cuda::pickDigit(block, sums, state, digit, counts.data()); });
  }
  EXPECT_EQ(state.known, launches.state.noise.known);
  EXPECT_EQ(state.rank, launches.state.noise.rank);
  EXPECT_EQ(state.lower, launches.state.noise.lower);
  EXPECT_GT(state.count, 1000u);
}

}  // namespace
}  // namespace rangepose
