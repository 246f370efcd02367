#include "gles/programs.h"

#include "core/error.h"

namespace rangepose::gles {

ProgramSource programSource(ProgramId id) {
  const Defines in_atlas = {{"RP_RANGE", "g"}};
  switch (id) {
    case ProgramId::kResample:
      return {"resample.vert", "resample.frag", {}, {}};
    case ProgramId::kMedian:
      return {"region.vert", "median.frag", {}, {}};
    case ProgramId::kEdges:
      return {"region.vert", "edges.frag", {}, {}};
    case ProgramId::kEdtInit:
      return {"region.vert", "edt_init.frag", {}, {}};
    case ProgramId::kEdtStep:
      return {"region.vert", "edt_step.frag", {}, {}};
    case ProgramId::kEdtRoot:
      return {"region.vert", "edt_root.frag", {"common/edt_distance.glsl"}, {}};
    case ProgramId::kPatchInit:
      return {"region.vert", "patch_init.frag", {}, {}};
    case ProgramId::kPatchStep:
      return {"region.vert", "patch_step.frag", {}, {}};
    case ProgramId::kPatchChanged:
      return {"region.vert", "patch_changed.frag", {}, {}};
    case ProgramId::kFrameWindow:
      return {"region.vert", "frame_window.frag", {}, {}};
    case ProgramId::kErrorPixel:
      return {"view_box.vert", "error_pixel.frag", {"common/state.glsl"}, {{"RP_ROW_STEP", "1"}}};
    case ProgramId::kErrorOfOtherRows:
      return {"view_box.vert", "error_pixel.frag", {"common/state.glsl"}, {{"RP_ROW_STEP", "2"}}};
    case ProgramId::kReduce:
      return {"view_box.vert", "reduce.frag", {"common/state.glsl"}, {}};
    case ProgramId::kSimplexStep:
      return {"region.vert",
              "simplex_step.frag",
              {"common/state.glsl", "common/error_value.glsl", "common/simplex.glsl"},
              {}};
    case ProgramId::kSimplexReplay:
      return {"region.vert",
              "simplex_step.frag",
              {"common/state.glsl", "common/error_value.glsl", "common/simplex.glsl"},
              {{"RP_REPLAY", "1"}}};
    case ProgramId::kSurface:
      return {"surface.vert", "surface.frag", {}, {}};
    case ProgramId::kReferenceView:
      return {"reference_view.vert", "reference_view.frag", {}, {}};
    case ProgramId::kReferenceEdges:
      return {"region.vert", "edges.frag", {}, in_atlas};
    case ProgramId::kReferenceEdtInit:
      return {"region.vert", "edt_init.frag", {}, in_atlas};
    case ProgramId::kReferenceTexel:
      return {"region.vert", "reference_texel.frag", {"common/edt_distance.glsl"}, {}};
    case ProgramId::kCount:
      break;
  }
  throw Error("unknown program");
}

}  // namespace rangepose::gles
