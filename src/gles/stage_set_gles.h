// The GLSL path: all stages as fragment passes.
#pragma once

#include <memory>

#include "gles/context.h"
#include "gles/program.h"
#include "stages/stage_set.h"

namespace rangepose::gles {

/// `extra` macros are defined in every shader. The context must outlive the stages and the scenes
/// that they prepare; each call makes it current on the calling thread. Keeps the atlas of each
/// object that it has searched on the device; objects must outlive it and not move.
std::unique_ptr<StageSet> makeGlesStages(Context& context, const Defines& extra = {});

}  // namespace rangepose::gles
