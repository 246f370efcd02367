// The CUDA path: all four stages as kernels; GL draws surfaces.
#pragma once

#include <memory>

#include "gles/context.h"
#include "stages/stage_set.h"

namespace rangepose::cuda {

/// `context` draws surfaces and must outlive the stages and their scenes; null: the host draws.
/// `shared`: images are GL textures of the context that CUDA shares; else they are copied. With
/// `staged` the search runs as the paper's three programs. For one thread at a time. Keeps the
/// views of each object that it has searched on the device.
std::unique_ptr<StageSet> makeCudaStages(gles::Context* context, bool shared, bool staged);

}  // namespace rangepose::cuda
