// Simplex states as texels: one column a view, seven rows. Twin: glsl/common/state.glsl.
#pragma once

#include <vector>

#include "gles/framebuffer.h"
#include "stages/simplex_core.h"

namespace rangepose::gles {

inline constexpr int kStateRows = 7;
inline constexpr int kStateCountersRow = 6;

Image<glm::vec4> packStates(const std::vector<SimplexState>& states);
std::vector<SimplexState> unpackStates(const Image<glm::vec4>& texels);

}  // namespace rangepose::gles
