// Downhill simplex over (x, y, z) as a pure state machine (paper Sect. 6.3; Nelder and Mead 1965).
// One call takes the value of the last candidate and gives the next one, so that every back-end can
// run thousands of searches in lockstep. Twin: glsl/simplex_step.frag.
#pragma once

#include "core/host_device.h"

namespace rangepose {

struct SimplexOptions {
  float step_px = 2.0f;     ///< initial edge length d (Sect. 6.3.1)
  float spread = 0.02f;     ///< stop when 2 |hi - lo| / (|hi| + |lo|) falls below (paper: 0.05)
  int max_iterations = 40;  ///< the paper sees 20-30
  void check() const;       ///< throws Error naming the bad field
};

/// What the value last asked for was: it decides what happens next.
enum class SimplexPhase : int {
  kVertex0 = 0,  ///< the four vertices of the first simplex, one after the other
  kVertex1,
  kVertex2,
  kVertex3,
  kReflect,
  kExpand,
  kContract,
  kShrink0,  ///< multiple contraction: vertices 0..3, without the best
  kShrink1,
  kShrink2,
  kShrink3,
  kDone,
};

struct SimplexPoint {
  float x, y, z;  ///< translation [px]
  float value;    ///< error there
};

/// Seven texels of RGBA32F: four vertices, the reflected point, the candidate, and the counters.
struct SimplexState {
  SimplexPoint vertex[4];
  SimplexPoint reflected;
  SimplexPoint candidate;  ///< value unused
  int phase;               ///< SimplexPhase
  int iterations;
  int highest;  ///< index of the worst vertex in this iteration
  int lowest;   ///< index of the best vertex; the answer once done
};

RP_HD SimplexState simplexStart(float x, float y, float z, float step) {
  SimplexState s{};
  s.vertex[0] = {x, y, z, 0.0f};
  s.vertex[1] = {x + step, y, z, 0.0f};
  s.vertex[2] = {x, y + step, z, 0.0f};
  s.vertex[3] = {x, y, z + step, 0.0f};
  s.candidate = s.vertex[0];
  s.phase = static_cast<int>(SimplexPhase::kVertex0);
  return s;
}

namespace simplex_detail {

// Vertices are looked up by comparing, not by indexing: an array that is indexed by a number known
// at run time cannot stay in the registers of a GPU's thread.

RP_HD SimplexPoint vertexAt(const SimplexState& s, int index) {
  SimplexPoint point = s.vertex[0];
  RP_UNROLL
  for (int i = 1; i < 4; ++i) {
    if (i == index) point = s.vertex[i];
  }
  return point;
}

RP_HD void setVertex(SimplexState& s, int index, const SimplexPoint& point) {
  RP_UNROLL
  for (int i = 0; i < 4; ++i) {
    if (i == index) s.vertex[i] = point;
  }
}

RP_HD void setValue(SimplexState& s, int index, float value) {
  RP_UNROLL
  for (int i = 0; i < 4; ++i) {
    if (i == index) s.vertex[i].value = value;
  }
}

/// The point at `centroid + t * (vertex[highest] - centroid)` with the centroid of the other three.
RP_HD SimplexPoint alongWorst(const SimplexState& s, float t) {
  float cx = 0.0f;
  float cy = 0.0f;
  float cz = 0.0f;
  RP_UNROLL
  for (int i = 0; i < 4; ++i) {
    if (i == s.highest) continue;
    cx += s.vertex[i].x;
    cy += s.vertex[i].y;
    cz += s.vertex[i].z;
  }
  cx /= 3.0f;
  cy /= 3.0f;
  cz /= 3.0f;
  const SimplexPoint w = vertexAt(s, s.highest);
  return {cx + t * (w.x - cx), cy + t * (w.y - cy), cz + t * (w.z - cz), 0.0f};
}

/// Ranks the vertices (on a tie the lower index), stops or asks for the reflection.
RP_HD void beginIteration(SimplexState& s, float spread, int max_iterations) {
  s.highest = 0;
  s.lowest = 0;
  float high = s.vertex[0].value;
  float low = s.vertex[0].value;
  RP_UNROLL
  for (int i = 1; i < 4; ++i) {
    const float value = s.vertex[i].value;
    if (value > high) {
      high = value;
      s.highest = i;
    }
    if (value < low) {
      low = value;
      s.lowest = i;
    }
  }
  const bool flat = 2.0f * (high - low) <= spread * (high + low);
  if (flat || s.iterations >= max_iterations) {
    s.phase = static_cast<int>(SimplexPhase::kDone);
    s.candidate = vertexAt(s, s.lowest);
    return;
  }
  ++s.iterations;
  s.candidate = alongWorst(s, -1.0f);
  s.phase = static_cast<int>(SimplexPhase::kReflect);
}

/// Asks for the next vertex of a multiple contraction from index `from` on, or ends it.
RP_HD void nextShrink(SimplexState& s, int from, float spread, int max_iterations) {
  const int index = from == s.lowest ? from + 1 : from;
  if (index > 3) {
    beginIteration(s, spread, max_iterations);
    return;
  }
  s.candidate = vertexAt(s, index);
  s.phase = static_cast<int>(SimplexPhase::kShrink0) + index;
}

}  // namespace simplex_detail

/// `value` is the error at the candidate; errors are >= 0. Afterwards the state has the next
/// candidate, or phase kDone and the answer in vertex[lowest].
RP_HD void simplexAdvance(SimplexState& s, float value, float spread, int max_iterations) {
  using namespace simplex_detail;
  const SimplexPoint tried = {s.candidate.x, s.candidate.y, s.candidate.z, value};
  const SimplexPhase phase = static_cast<SimplexPhase>(s.phase);
  if (phase == SimplexPhase::kDone) return;
  if (phase <= SimplexPhase::kVertex3) {
    setValue(s, s.phase, value);
    if (phase == SimplexPhase::kVertex3) {
      beginIteration(s, spread, max_iterations);
    } else {
      ++s.phase;
      s.candidate = vertexAt(s, s.phase);
    }
    return;
  }
  if (phase == SimplexPhase::kReflect) {
    const float lowest = vertexAt(s, s.lowest).value;
    float second = lowest;
    RP_UNROLL
    for (int i = 0; i < 4; ++i) {
      if (i != s.highest && s.vertex[i].value > second) second = s.vertex[i].value;
    }
    if (value < lowest) {
      s.reflected = tried;
      s.candidate = alongWorst(s, -2.0f);
      s.phase = static_cast<int>(SimplexPhase::kExpand);
    } else if (value < second) {
      setVertex(s, s.highest, tried);
      beginIteration(s, spread, max_iterations);
    } else {
      if (value < vertexAt(s, s.highest).value) setVertex(s, s.highest, tried);
      s.candidate = alongWorst(s, 0.5f);
      s.phase = static_cast<int>(SimplexPhase::kContract);
    }
    return;
  }
  if (phase == SimplexPhase::kExpand) {
    if (value < s.reflected.value) {
      setVertex(s, s.highest, tried);
    } else {
      setVertex(s, s.highest, s.reflected);
    }
    beginIteration(s, spread, max_iterations);
    return;
  }
  if (phase == SimplexPhase::kContract) {
    if (value < vertexAt(s, s.highest).value) {
      setVertex(s, s.highest, tried);
      beginIteration(s, spread, max_iterations);
      return;
    }
    const SimplexPoint best = vertexAt(s, s.lowest);
    RP_UNROLL
    for (int i = 0; i < 4; ++i) {
      SimplexPoint& v = s.vertex[i];
      if (i != s.lowest)
        v = {0.5f * (v.x + best.x), 0.5f * (v.y + best.y), 0.5f * (v.z + best.z), 0.0f};
    }
    nextShrink(s, 0, spread, max_iterations);
    return;
  }
  const int index = s.phase - static_cast<int>(SimplexPhase::kShrink0);
  setValue(s, index, value);
  nextShrink(s, index + 1, spread, max_iterations);
}

/// The same, leaving `state` as it is.
RP_HD SimplexState simplexStep(const SimplexState& state,
                               float value,
                               float spread,
                               int max_iterations) {
  SimplexState next = state;
  simplexAdvance(next, value, spread, max_iterations);
  return next;
}

}  // namespace rangepose
