#include "gles/search_state.h"

#include <cstddef>

namespace rangepose::gles {
namespace {

glm::vec4 texelOf(const SimplexPoint& point) { return {point.x, point.y, point.z, point.value}; }

SimplexPoint pointOf(const glm::vec4& texel) { return {texel.x, texel.y, texel.z, texel.w}; }

}  // namespace

Image<glm::vec4> packStates(const std::vector<SimplexState>& states) {
  Image<glm::vec4> texels(static_cast<int>(states.size()), kStateRows);
  for (int i = 0; i < texels.width(); ++i) {
    const SimplexState& state = states[static_cast<std::size_t>(i)];
    for (int v = 0; v < 4; ++v) texels.at(i, v) = texelOf(state.vertex[v]);
    texels.at(i, 4) = texelOf(state.reflected);
    texels.at(i, 5) = texelOf(state.candidate);
    texels.at(i, kStateCountersRow) =
        glm::vec4(state.phase, state.iterations, state.highest, state.lowest);
  }
  return texels;
}

std::vector<SimplexState> unpackStates(const Image<glm::vec4>& texels) {
  std::vector<SimplexState> states(static_cast<std::size_t>(texels.width()));
  for (int i = 0; i < texels.width(); ++i) {
    SimplexState& state = states[static_cast<std::size_t>(i)];
    for (int v = 0; v < 4; ++v) state.vertex[v] = pointOf(texels.at(i, v));
    state.reflected = pointOf(texels.at(i, 4));
    state.candidate = pointOf(texels.at(i, 5));
    const glm::vec4 counters = texels.at(i, kStateCountersRow);
    state.phase = static_cast<int>(counters.x);
    state.iterations = static_cast<int>(counters.y);
    state.highest = static_cast<int>(counters.z);
    state.lowest = static_cast<int>(counters.w);
  }
  return states;
}

}  // namespace rangepose::gles
