// One simplex step of one view (paper Sect. 6.3.2): every fragment repeats the whole step and
// writes its row. Twin of simplexStep in src/stages/simplex_core.h.
uniform sampler2D u_state;
uniform float u_spread;
uniform int u_max_iterations;
#ifdef RP_REPLAY
uniform sampler2D u_values;  // error of each view's candidate, one row
#else
uniform sampler2D u_terms;   // the four sums of each view, u_columns views a row
uniform sampler2D u_areas;   // r_i of each view, one row
uniform int u_columns;
uniform float u_lambda_per_px;
#endif
layout(location = 0) out highp vec4 o_state;

vec4 row(int view, int index) { return texelFetch(u_state, ivec2(view, index), 0); }

float valueOf(int view) {
#ifdef RP_REPLAY
  return texelFetch(u_values, ivec2(view, 0), 0).r;
#else
  vec4 terms = texelFetch(u_terms, ivec2(view % u_columns, view / u_columns), 0);
  return errorValue(terms, u_lambda_per_px, texelFetch(u_areas, ivec2(view, 0), 0).r);
#endif
}

void main() {
  int view = int(gl_FragCoord.x);
  int written = int(gl_FragCoord.y);
  ivec4 counters = ivec4(row(view, kRowCounters));
  Simplex s;
  for (int i = 0; i < 4; ++i) s.vertex[i] = row(view, i);
  s.reflected = row(view, kRowReflected);
  s.candidate = row(view, kRowCandidate);
  s.phase = counters.x;
  s.iterations = counters.y;
  s.highest = counters.z;
  s.lowest = counters.w;
  simplexStep(s, valueOf(view), u_spread, u_max_iterations);
  if (written < 4) o_state = s.vertex[written];
  if (written == kRowReflected) o_state = s.reflected;
  if (written == kRowCandidate) o_state = s.candidate;
  if (written == kRowCounters) {
    o_state = vec4(float(s.phase), float(s.iterations), float(s.highest), float(s.lowest));
  }
}
