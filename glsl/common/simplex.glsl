// Downhill simplex over (x, y, z) as a state machine (paper Sect. 6.3).
// Twin of src/stages/simplex_core.h: same branches, same order of sums.
struct Simplex {
  vec4 vertex[4];  // xyz translation [px], w error there
  vec4 reflected;
  vec4 candidate;
  int phase;
  int iterations;
  int highest;
  int lowest;
};

// The point at centroid + t * (worst - centroid), with the centroid of the other three.
vec4 alongWorst(Simplex s, float t) {
  vec3 middle = vec3(0.0);
  for (int i = 0; i < 4; ++i) {
    if (i != s.highest) middle += s.vertex[i].xyz;
  }
  middle /= 3.0;
  RP_PRECISE vec3 point = middle + t * (s.vertex[s.highest].xyz - middle);
  return vec4(point, 0.0);
}

void beginIteration(inout Simplex s, float spread, int max_iterations) {
  s.highest = 0;
  s.lowest = 0;
  for (int i = 1; i < 4; ++i) {
    if (s.vertex[i].w > s.vertex[s.highest].w) s.highest = i;
    if (s.vertex[i].w < s.vertex[s.lowest].w) s.lowest = i;
  }
  float high = s.vertex[s.highest].w;
  float low = s.vertex[s.lowest].w;
  bool level = 2.0 * (high - low) <= spread * (high + low);
  if (level || s.iterations >= max_iterations) {
    s.phase = kDone;
    s.candidate = s.vertex[s.lowest];
    return;
  }
  ++s.iterations;
  s.candidate = alongWorst(s, -1.0);
  s.phase = kReflect;
}

void nextShrink(inout Simplex s, int from, float spread, int max_iterations) {
  int index = from == s.lowest ? from + 1 : from;
  if (index > 3) {
    beginIteration(s, spread, max_iterations);
    return;
  }
  s.candidate = s.vertex[index];
  s.phase = kShrink0 + index;
}

void afterReflection(inout Simplex s, vec4 tried, float spread, int max_iterations) {
  float second = s.vertex[s.lowest].w;
  for (int i = 0; i < 4; ++i) {
    if (i != s.highest && s.vertex[i].w > second) second = s.vertex[i].w;
  }
  if (tried.w < s.vertex[s.lowest].w) {
    s.reflected = tried;
    s.candidate = alongWorst(s, -2.0);
    s.phase = kExpand;
  } else if (tried.w < second) {
    s.vertex[s.highest] = tried;
    beginIteration(s, spread, max_iterations);
  } else {
    if (tried.w < s.vertex[s.highest].w) s.vertex[s.highest] = tried;
    s.candidate = alongWorst(s, 0.5);
    s.phase = kContract;
  }
}

void afterContraction(inout Simplex s, vec4 tried, float spread, int max_iterations) {
  if (tried.w < s.vertex[s.highest].w) {
    s.vertex[s.highest] = tried;
    beginIteration(s, spread, max_iterations);
    return;
  }
  vec4 best = s.vertex[s.lowest];
  for (int i = 0; i < 4; ++i) {
    if (i != s.lowest) s.vertex[i] = vec4(0.5 * (s.vertex[i].xyz + best.xyz), 0.0);
  }
  nextShrink(s, 0, spread, max_iterations);
}

// `value` is the error at s.candidate.
void simplexStep(inout Simplex s, float value, float spread, int max_iterations) {
  vec4 tried = vec4(s.candidate.xyz, value);
  if (s.phase == kDone) return;
  if (s.phase <= kVertex3) {
    s.vertex[s.phase].w = value;
    if (s.phase == kVertex3) {
      beginIteration(s, spread, max_iterations);
    } else {
      ++s.phase;
      s.candidate = s.vertex[s.phase];
    }
  } else if (s.phase == kReflect) {
    afterReflection(s, tried, spread, max_iterations);
  } else if (s.phase == kExpand) {
    s.vertex[s.highest] = value < s.reflected.w ? tried : s.reflected;
    beginIteration(s, spread, max_iterations);
  } else if (s.phase == kContract) {
    afterContraction(s, tried, spread, max_iterations);
  } else {
    int index = s.phase - kShrink0;
    s.vertex[index].w = value;
    nextShrink(s, index + 1, spread, max_iterations);
  }
}
