#include "gles/search_gles.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/error.h"
#include "gles/search_state.h"

namespace rangepose::gles {
namespace {

/// Width of a tile whose texels hold the sums of 2^level x 2^level pixels.
int pitchOf(int size, int level) { return (size + (1 << level) - 1) >> level; }

/// What the error pass writes: sums of 2^kFirstLevel x 2^kFirstLevel pixels.
constexpr int kFirstLevel = 2;
/// A pass of the reduction adds 2^kLevelStep x 2^kLevelStep sums.
constexpr int kLevelStep = 2;

std::vector<Canvas> makeLevels(int size, int columns, int rows) {
  std::vector<Canvas> levels;
  for (int level = kFirstLevel;; level += kLevelStep) {
    const int pitch = pitchOf(size, level);
    levels.emplace_back(Format::kRgba32f, columns * pitch, rows * pitch);
    levels.back().framebuffer.clear(glm::vec4(0.0f));
    if (pitch == 1) return levels;
  }
}

Buffer boxBuffer(const ReferenceObject& object) {
  std::vector<PixelBox> boxes;
  boxes.reserve(object.views.size());
  for (const ReferenceView& view : object.views) boxes.push_back(view.box);
  return {boxes.data(), boxes.size() * sizeof(PixelBox)};
}

void checkObject(const ReferenceObject& object) {
  RP_CHECK(!object.views.empty() && object.size > 0 && !object.atlas.empty() &&
               object.atlas.width() % object.size == 0 && object.atlas.height() % object.size == 0,
           "object " + std::to_string(object.id) + ": the atlas has no whole tiles");
  const int tiles = object.columns() * (object.atlas.height() / object.size);
  RP_CHECK(static_cast<int>(object.views.size()) <= tiles,
           "object " + std::to_string(object.id) + ": the atlas has fewer tiles than views");
}

/// A window with background around it, wide enough for all shifts.
struct FramedWindow {
  FramedWindow(Device& device, const ResidentObject& object, const WindowTextures& window)
      : margin((window.range_px.width() - object.size()) / 2),
        pad(std::max(0, static_cast<int>(std::ceil(maxShiftPx(object.size()))) + 1 - margin)),
        texels(
            Format::kRg32f, window.range_px.width() + 2 * pad, window.range_px.height() + 2 * pad) {
    const glm::ivec2 size(texels.texture.width(), texels.texture.height());
    Pass(device, ProgramId::kFrameWindow, texels.framebuffer)
        .texture("u_scene_range", window.range_px)
        .texture("u_scene_distance", window.distance_px)
        .set("u_target_size", size)
        .set("u_pad", pad)
        .set("u_outside_distance", object.outsideDistance())
        .draw(Regions(size.x, size.y));
  }
  int origin() const { return pad + margin; }

  int margin;  ///< of a tile in the window [px]
  int pad;     ///< background on each side [px]
  Canvas texels;
};

Pass viewPass(Device& device,
              ProgramId program,
              const ResidentObject& object,
              const Texture& state,
              int level) {
  const Framebuffer& target = object.level(level).framebuffer;
  Pass pass(device, program, target);
  pass.texture("u_state", state)
      .set("u_target_size", glm::ivec2(target.width(), target.height()))
      .set("u_columns", object.columns())
      .set("u_size", object.size())
      .set("u_level", level);
  return pass;
}

/// The sums of every view at the candidate of its state; views that are done keep their last ones.
const Texture& evaluate(Device& device,
                        const ResidentObject& object,
                        const FramedWindow& window,
                        const Texture& state,
                        const ErrorOptions& options) {
  const RangeRule rule = rangeRule(options.range_limit_px, options.holes);
  const ProgramId errors =
      options.row_step == 1 ? ProgramId::kErrorPixel : ProgramId::kErrorOfOtherRows;
  viewPass(device, errors, object, state, kFirstLevel)
      .texture("u_atlas", object.atlas())
      .texture("u_window", window.texels.texture)
      .set("u_origin", window.origin())
      .set("u_max_shift", maxShiftPx(object.size()))
      .set("u_range_rule", glm::vec3(rule.limit, rule.hole_gap, rule.hole_weight))
      .drawQuads(object.boxes(), object.views());
  for (int level = kFirstLevel + kLevelStep; level <= object.lastLevel(); level += kLevelStep) {
    viewPass(device, ProgramId::kReduce, object, state, level)
        .texture("u_previous", object.level(level - kLevelStep).texture)
        .set("u_previous_pitch", pitchOf(object.size(), level - kLevelStep))
        .set("u_step", kLevelStep)
        .drawQuads(object.boxes(), object.views());
  }
  return object.level(object.lastLevel()).texture;
}

Canvas stateCanvas(const std::vector<SimplexState>& states) {
  Canvas canvas(Format::kRgba32f, static_cast<int>(states.size()), kStateRows);
  canvas.texture.upload(packStates(states).data());
  return canvas;
}

Image<float> rowOf(const std::vector<float>& values) {
  Image<float> row(static_cast<int>(values.size()), 1);
  std::copy(values.begin(), values.end(), row.begin());
  return row;
}

bool allDone(const Texture& state) {
  std::vector<glm::vec4> counters(static_cast<std::size_t>(state.width()));
  state.downloadRgba(kStateCountersRow, 1, &counters.data()->x);
  return std::all_of(counters.begin(), counters.end(), [](const glm::vec4& texel) {
    return static_cast<int>(texel.x) == static_cast<int>(SimplexPhase::kDone);
  });
}

Pass stepPass(Device& device,
              ProgramId program,
              const Canvas& from,
              const Canvas& into,
              const SimplexOptions& options) {
  Pass pass(device, program, into.framebuffer);
  pass.texture("u_state", from.texture)
      .set("u_target_size", glm::ivec2(into.texture.width(), into.texture.height()))
      .set("u_spread", options.spread)
      .set("u_max_iterations", options.max_iterations);
  return pass;
}

std::vector<Hypothesis> answers(const Texture& state) {
  std::vector<Hypothesis> hypotheses;
  for (const SimplexState& s : unpackStates(downloadVectors(state))) {
    const SimplexPoint& best = s.vertex[s.lowest];
    Hypothesis hypothesis;
    hypothesis.view = static_cast<int>(hypotheses.size());
    hypothesis.translation_px = {best.x, best.y, best.z};
    hypothesis.error = best.value;
    hypothesis.iterations = s.iterations;
    hypotheses.push_back(hypothesis);
  }
  return hypotheses;
}

}  // namespace

ResidentObject::ResidentObject(const ReferenceObject& object)
    : views_((checkObject(object), static_cast<int>(object.views.size()))),
      size_(object.size),
      columns_(object.columns()),
      outside_distance_(-static_cast<float>(object.edt_passes + 1)),
      atlas_(object.atlas),
      boxes_(boxBuffer(object)),
      levels_(makeLevels(size_, columns_, object.atlas.height() / object.size)) {
  box_vertices_.add(boxes_, {0, 4, true, sizeof(PixelBox), 0, true});
}

const Canvas& ResidentObject::level(int k) const {
  return levels_[static_cast<std::size_t>((k - kFirstLevel) / kLevelStep)];
}

int ResidentObject::lastLevel() const {
  return kFirstLevel + kLevelStep * (static_cast<int>(levels_.size()) - 1);
}

std::vector<ErrorTerms> errorTerms(Device& device,
                                   const ResidentObject& object,
                                   const WindowTextures& window,
                                   const std::vector<glm::vec3>& translations_px,
                                   const ErrorOptions& options) {
  RP_CHECK(static_cast<int>(translations_px.size()) == object.views(),
           "one translation a view is needed");
  std::vector<SimplexState> states;
  states.reserve(translations_px.size());
  for (const glm::vec3& t : translations_px) states.push_back(simplexStart(t.x, t.y, t.z, 0.0f));
  const Canvas state = stateCanvas(states);
  const FramedWindow framed(device, object, window);
  const Image<glm::vec4> sums =
      downloadVectors(evaluate(device, object, framed, state.texture, options));
  std::vector<ErrorTerms> terms;
  terms.reserve(states.size());
  for (std::size_t i = 0; i < states.size(); ++i) {
    const glm::vec4 texel = sums.data()[i];
    terms.push_back({texel.x, texel.y, texel.z, texel.w});
  }
  return terms;
}

std::vector<SimplexState> simplexSteps(Device& device,
                                       const std::vector<SimplexState>& states,
                                       const std::vector<float>& values,
                                       const SimplexOptions& options) {
  RP_CHECK(states.size() == values.size(), "one value a state is needed");
  if (states.empty()) return {};
  const Canvas from = stateCanvas(states);
  const Canvas into(Format::kRgba32f, from.texture.width(), kStateRows);
  const Texture value_row(rowOf(values));
  stepPass(device, ProgramId::kSimplexReplay, from, into, options)
      .texture("u_values", value_row)
      .draw(Regions(into.texture.width(), kStateRows));
  return unpackStates(downloadVectors(into.texture));
}

std::vector<Hypothesis> search(Device& device,
                               const ResidentObject& object,
                               const WindowTextures& window,
                               const std::vector<glm::vec3>& starts_px,
                               const std::vector<float>& area_factors,
                               const SearchOptions& options) {
  constexpr int kStepsPerCheck = 4;  // reading the phases waits for the device
  std::vector<SimplexState> states;
  states.reserve(starts_px.size());
  for (const glm::vec3& start : starts_px) {
    states.push_back(simplexStart(start.x, start.y, start.z, options.simplex.step_px));
  }
  Canvas current = stateCanvas(states);
  Canvas next(Format::kRgba32f, current.texture.width(), kStateRows);
  const Texture areas(rowOf(area_factors));
  const FramedWindow framed(device, object, window);
  const Regions whole(current.texture.width(), kStateRows);
  // A simplex asks at most 4 + 5 * max_iterations times, so this ends.
  for (int step = 1;; ++step) {
    const Texture& terms = evaluate(device, object, framed, current.texture, options.error);
    stepPass(device, ProgramId::kSimplexStep, current, next, options.simplex)
        .texture("u_terms", terms)
        .texture("u_areas", areas)
        .set("u_columns", object.columns())
        .set("u_lambda_per_px", options.error.lambdaPerPx())
        .draw(whole);
    std::swap(current, next);
    if (step % kStepsPerCheck == 0 && allDone(current.texture)) return answers(current.texture);
  }
}

}  // namespace rangepose::gles
