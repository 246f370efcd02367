// The programs of all passes: which files of glsl/ make them up.
#pragma once

#include "gles/program.h"

namespace rangepose::gles {

enum class ProgramId {
  kResample,
  kMedian,
  kEdges,
  kEdtInit,
  kEdtStep,
  kEdtRoot,
  kPatchInit,
  kPatchStep,
  kPatchChanged,
  kFrameWindow,
  kErrorPixel,
  kErrorOfOtherRows,  ///< with every other row left out
  kReduce,
  kSimplexStep,
  kSimplexReplay,
  kSurface,
  kReferenceView,
  kReferenceEdges,
  kReferenceEdtInit,
  kReferenceTexel,
  kCount,
};

/// Every file in glsl/ is part of at least one of them.
ProgramSource programSource(ProgramId id);

}  // namespace rangepose::gles
