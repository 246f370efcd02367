// Background planes on the device (see host::findBackground): samples of the image, then rounds of
// two launches: one tries all planes, a block each, the other fits the best, decides what it is and
// takes its samples out.
#pragma once

#include <cstdint>

#include "cuda/block.h"
#include "cuda/foreground_types.h"
#include "stages/dropouts_core.h"

namespace rangepose::cuda {

/// Depth of a pixel [mm] with lost pixels filled; `lost` says whether it was one. `read(u, v)`
/// gives a depth [mm].
template <typename Read>
RP_BODY float filledPixel(
    const Camera& camera, const Read& read, int u, int v, double noise_mm, bool& lost) {
  const float mm = read(u, v);
  lost = false;
  if (mm != 0.0f || u == 0 || v == 0 || u + 1 == camera.width || v + 1 == camera.height) return mm;
  const float filled = filledDropout(camera, read, u, v, noise_mm);
  lost = filled != 0.0f;
  return filled;
}

/// Whether a pixel of that depth [mm] is foreground, by the planes found so far.
RP_BODY bool isForeground(
    const ForegroundState& state, const ForegroundRules& rules, int u, int v, float mm) {
  return mm > 0.0f && keeps(rules.bin,
                            state.plane,
                            state.planes,
                            state.tolerance_mm,
                            rules.camera.unproject(u, v, mm));
}

/// Calls `place(thread, first)` for each thread, `first` being how many things the threads before
/// it have; `total` is how many all have.
template <typename Block, typename Count, typename Place>
RP_BODY void placeInOrder(Block& block,
                          int (&first)[Block::kThreads],
                          int& total,
                          const Count& count,
                          const Place& place) {
  block.forEachThread([&](int thread) { first[thread] = count(thread); });
  block.barrier();
  block.leader([&] {
    int sum = 0;
    for (int i = 0; i < Block::kThreads; ++i) {
      const int own = first[i];
      first[i] = sum;
      sum += own;
    }
    total = sum;
  });
  block.barrier();
  block.forEachThread([&](int thread) { place(thread, first[thread]); });
}

/// The first of `count` things that are a thread's; those of thread i end where those of i + 1
/// begin.
RP_HD int chunkBegin(int thread, int threads, int count) {
  return static_cast<int>(static_cast<long long>(thread) * count / threads);
}

/// `read(u, v)` gives a depth [mm], also 0 outside of the image.
template <typename Block, typename Read>
RP_BODY void takeSamples(Block& block,
                         int (&first)[Block::kThreads],
                         const ForegroundRules& rules,
                         const Read& read,
                         const SampleArrays& into,
                         ForegroundState& state) {
  const Camera& camera = rules.camera;
  const bool filled = areMany(state.lost, state.measured);
  const int stride = sampleStride(static_cast<double>(state.measured + (filled ? state.lost : 0)));
  const int columns = (camera.width + stride - 1) / stride;
  const int cells = columns * ((camera.height + stride - 1) / stride);
  const auto visit = [&](int thread, const auto& see) {
    const int end = chunkBegin(thread + 1, Block::kThreads, cells);
    for (int i = chunkBegin(thread, Block::kThreads, cells); i < end; ++i) {
      const int u = i % columns * stride;
      const int v = i / columns * stride;
      if (read(u, v) > 0.0f) see(u, v);
    }
  };
  placeInOrder(
      block,
      first,
      state.samples,
      [&](int thread) {
        int count = 0;
        visit(thread, [&](int, int) { ++count; });
        return count;
      },
      [&](int thread, int at) {
        visit(thread, [&](int u, int v) {
          into.set(at++, sampleAt(camera, read, u, v, rules.options.part_mm));
        });
      });
  block.leader([&] {
    state.total = static_cast<double>(state.samples);
    state.tolerance_mm =
        toleranceAt(state.noise.noise_mm, rules.options.tolerance_mm, rules.thin_mm);
    state.side = 0;
    state.planes = 0;
    state.best = 0;
    state.done = state.samples > kFewestSamples && rules.options.max_planes > 0 ? 0 : 1;
  });
}

/// The plane of a trial, if there is one. `draws`: those of the round.
RP_BODY bool planeOfTrial(const ForegroundState& state,
                          const ForegroundRules& rules,
                          const SampleArrays& samples,
                          const std::uint64_t* draws,
                          int trial,
                          BackgroundPlane& plane) {
  SurfaceSample three[3];
  for (int k = 0; k < 3; ++k) {
    const std::uint64_t drawn = draws[3 * trial + k];
    three[k] = samples.get(static_cast<int>(drawn % static_cast<std::uint64_t>(state.samples)));
  }
  return planeThrough(three,
                      rules.camera.orthographic,
                      state.tolerance_mm,
                      state.planes > 0 ? &state.plane[0] : nullptr,
                      plane);
}

struct TrialShared {
  BackgroundPlane plane;
  bool exists;
};

/// Counts the samples on a plane; `raise(key)` must keep the largest key.
template <typename Block, typename Raise>
RP_BODY void tryPlane(Block& block,
                      TrialShared& shared,
                      const ForegroundState& state,
                      const ForegroundRules& rules,
                      const SampleArrays (&arrays)[2],
                      const std::uint64_t* draws,
                      int trial,
                      const Raise& raise) {
  struct Counts {
    int on;
    int behind;
  };
  if (state.done != 0) return;
  const SampleArrays& samples = arrays[state.side];
  block.leader(
      [&] { shared.exists = planeOfTrial(state, rules, samples, draws, trial, shared.plane); });
  block.barrier();
  if (!shared.exists) return;
  const int stride = trialStride(state.samples);
  const double tolerance_mm = state.tolerance_mm;
  const BackgroundPlane plane = shared.plane;
  typename Block::template PerThread<Counts> counts;
  block.forEachThread([&](int thread) {
    Counts own{0, 0};
    for (int i = thread * stride; i < state.samples; i += Block::kThreads * stride) {
      const SurfaceSample sample = samples.get(i);
      own.on += liesOn(sample, plane, tolerance_mm) ? 1 : 0;
      own.behind += plane.heightOf(sample.point) < -3.0 * tolerance_mm ? 1 : 0;
    }
    counts[thread] = own;
  });
  const double max_behind = rules.options.max_behind * state.total / static_cast<double>(stride);
  block.template sum<int>(counts, [&](const Counts& all) {
    if (all.on > 0 && !(static_cast<double>(all.behind) > max_behind))
      raise(planeKey(all.on, trial));
  });
}

/// What the threads of a block that settles a plane have in common.
template <int kThreads>
struct RoundShared {
  BackgroundPlane plane;
  glm::dvec3 mean;
  glm::dmat3 covariance;
  double count;  ///< samples on the plane
  PlaneKind kind;
  int above;  ///< samples that stand out of it
  int first[kThreads];
};

/// Mean and scatter of the samples on the plane.
template <typename Block>
RP_BODY void scatterOnPlane(Block& block,
                            RoundShared<Block::kThreads>& shared,
                            const SampleArrays& samples,
                            int count,
                            double tolerance_mm) {
  struct First {
    double n, x, y, z;
  };
  struct Second {
    double xx, xy, xz, yy, yz, zz;
  };
  typename Block::template PerThread<First> firsts;
  typename Block::template PerThread<Second> seconds;
  block.forEachThread([&](int thread) {
    First sum{0.0, 0.0, 0.0, 0.0};
    for (int i = thread; i < count; i += Block::kThreads) {
      const SurfaceSample sample = samples.get(i);
      if (!liesOn(sample, shared.plane, tolerance_mm)) continue;
      sum.n += 1.0;
      sum.x += sample.point.x;
      sum.y += sample.point.y;
      sum.z += sample.point.z;
    }
    firsts[thread] = sum;
  });
  block.template sum<double>(firsts, [&](const First& all) {
    shared.count = all.n;
    if (all.n > 0.0) shared.mean = glm::dvec3(all.x, all.y, all.z) / all.n;
  });
  block.forEachThread([&](int thread) {
    Second sum{0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
    for (int i = thread; i < count; i += Block::kThreads) {
      const SurfaceSample sample = samples.get(i);
      if (!liesOn(sample, shared.plane, tolerance_mm)) continue;
      const glm::dvec3 d = sample.point - shared.mean;
      sum.xx += d.x * d.x;
      sum.xy += d.x * d.y;
      sum.xz += d.x * d.z;
      sum.yy += d.y * d.y;
      sum.yz += d.y * d.z;
      sum.zz += d.z * d.z;
    }
    seconds[thread] = sum;
  });
  block.template sum<double>(seconds, [&](const Second& all) {
    const glm::dmat3 sums(all.xx, all.xy, all.xz, all.xy, all.yy, all.yz, all.xz, all.yz, all.zz);
    shared.covariance = shared.count > 0.0 ? sums / shared.count : glm::dmat3(0.0);
  });
}

/// Fits the best plane of a round, decides what it is and takes out what is on or behind it.
template <typename Block>
RP_BODY void settlePlane(Block& block,
                         RoundShared<Block::kThreads>& shared,
                         ForegroundState& state,
                         const ForegroundRules& rules,
                         const SampleArrays (&arrays)[2],
                         const std::uint64_t* draws) {
  if (state.done != 0) return;
  const SampleArrays& from = arrays[state.side];
  const SampleArrays& into = arrays[1 - state.side];
  const int count = state.samples;
  const double tolerance_mm = state.tolerance_mm;
  const bool found = state.best != 0;
  block.leader([&] {
    shared.plane = BackgroundPlane{};
    if (found) planeOfTrial(state, rules, from, draws, trialOf(state.best), shared.plane);
  });
  block.barrier();
  for (int fit = 0; fit < kPlaneFits && found; ++fit) {
    scatterOnPlane(block, shared, from, count, tolerance_mm);
    if (shared.count < 3.0) break;
    block.leader([&] {
      shared.plane = facingCamera(thinDirection(shared.covariance, shared.plane.normal),
                                  shared.mean,
                                  rules.camera.orthographic);
    });
    block.barrier();
  }
  scatterOnPlane(block, shared, from, count, tolerance_mm);
  typename Block::template PerThread<int> above;
  block.forEachThread([&](int thread) {
    int own = 0;
    for (int i = thread; i < count; i += Block::kThreads)
      own += standsOut(from.get(i), shared.plane, tolerance_mm) ? 1 : 0;
    above[thread] = own;
  });
  block.template sum<int>(above, [&](int all) { shared.above = all; });
  block.leader([&] {
    const bool is_floor = state.planes == 0;
    shared.kind = kindOf(
        shared.covariance, shared.plane.normal, shared.count, state.total, is_floor, rules.options);
    // A plane with nothing on it may be the parts themselves: flat ones, their table cut away.
    if (shared.kind == PlaneKind::kBackground &&
        static_cast<double>(shared.above) < rules.options.min_above * state.total)
      shared.kind = PlaneKind::kNothing;
    if (shared.kind == PlaneKind::kBackground) state.plane[state.planes++] = shared.plane;
    if (shared.kind == PlaneKind::kNothing) state.done = 1;
  });
  block.barrier();
  if (shared.kind == PlaneKind::kNothing) return;
  const auto visit = [&](int thread, const auto& see) {
    const int end = chunkBegin(thread + 1, Block::kThreads, count);
    for (int i = chunkBegin(thread, Block::kThreads, count); i < end; ++i) {
      const SurfaceSample sample = from.get(i);
      if (remains(sample, shared.plane, shared.kind, tolerance_mm)) see(sample);
    }
  };
  placeInOrder(
      block,
      shared.first,
      state.samples,
      [&](int thread) {
        int left = 0;
        visit(thread, [&](const SurfaceSample&) { ++left; });
        return left;
      },
      [&](int thread, int at) {
        visit(thread, [&](const SurfaceSample& sample) { into.set(at++, sample); });
      });
  block.leader([&] {
    state.side = 1 - state.side;
    state.best = 0;
    if (state.planes >= rules.options.max_planes || state.samples <= kFewestSamples) state.done = 1;
  });
}

}  // namespace rangepose::cuda
