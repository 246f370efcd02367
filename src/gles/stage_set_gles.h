// The GLSL path: scene images, search and drawing as fragment passes.
#pragma once

#include <memory>

#include "gles/context.h"
#include "gles/program.h"
#include "stages/stage_set.h"

namespace rangepose::gles {

/// What the path has no passes for, in words. Alignment solves six equations a pose and a round;
/// the relief of a verdict is what is left of sums that cancel to some millionths: both want
/// doubles, which GLES has not. Planes of the background are tried at random points, one after the
/// other, and ask after each whether to go on.
inline constexpr const char* kLeftToHost = "foreground, alignment, verdicts";

/// `extra` macros are defined in every shader. The context must outlive the stages and the scenes
/// that they prepare; each call makes it current on the calling thread. Keeps the atlas of each
/// object that it has searched on the device; objects must outlive it and not move.
std::unique_ptr<StageSet> makeGlesStages(Context& context, const Defines& extra = {});

}  // namespace rangepose::gles
