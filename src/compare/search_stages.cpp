#include "compare/search_stages.h"

#include <memory>
#include <utility>

#include "stages/search.h"

namespace rangepose {
namespace {

/// Sums smaller than this are compared in absolute terms [px]: a few pixels that cancel out.
constexpr double kSmallSumPx = 10.0;

/// The largest share by which one of the four sums differs.
double termsDifference(const ErrorTerms& a, const ErrorTerms& b) {
  const auto gap = [](float left, float right) {
    return relativeDifference(static_cast<double>(left), static_cast<double>(right), kSmallSumPx);
  };
  return std::max(std::max(gap(a.cover_sum, b.cover_sum), gap(a.cover_count, b.cover_count)),
                  std::max(gap(a.range_sum, b.range_sum), gap(a.range_weight, b.range_weight)));
}

double pointDifference(const SimplexPoint& a, const SimplexPoint& b) {
  return static_cast<double>(std::max(std::max(std::abs(a.x - b.x), std::abs(a.y - b.y)),
                                      std::max(std::abs(a.z - b.z), std::abs(a.value - b.value))));
}

/// Another phase or rank counts as a whole pixel.
double stateDifference(const SimplexState& a, const SimplexState& b) {
  const bool same_course = a.phase == b.phase && a.iterations == b.iterations &&
                           a.highest == b.highest && a.lowest == b.lowest;
  double difference = same_course ? 0.0 : 1.0;
  for (int i = 0; i < 4; ++i) {
    difference = std::max(difference, pointDifference(a.vertex[i], b.vertex[i]));
  }
  difference = std::max(difference, pointDifference(a.candidate, b.candidate));
  // Its value is only set once it was tried.
  const bool reflected = a.phase == static_cast<int>(SimplexPhase::kExpand);
  return reflected ? std::max(difference, pointDifference(a.reflected, b.reflected)) : difference;
}

glm::vec3 candidateOf(const SimplexState& state) {
  return {state.candidate.x, state.candidate.y, state.candidate.z};
}

bool allDone(const std::vector<SimplexState>& states) {
  return std::all_of(states.begin(), states.end(), [](const SimplexState& state) {
    return state.phase == static_cast<int>(SimplexPhase::kDone);
  });
}

const Hypothesis* find(const std::vector<Hypothesis>& all, int view, int window) {
  const auto found = std::find_if(all.begin(), all.end(), [&](const Hypothesis& hypothesis) {
    return hypothesis.view == view && hypothesis.window == window;
  });
  return found == all.end() ? nullptr : &*found;
}

}  // namespace

SearchComparison::SearchComparison(StageSet& reference, StageSet& subject)
    : reference_(reference),
      subject_(subject),
      terms_("error terms", subject.name),
      steps_("simplex steps", subject.name),
      errors_("search errors", subject.name),
      winners_("search winners", subject.name) {}

void SearchComparison::compare(const ReferenceObject& object, const ObjectTrace& trace) {
  for (std::size_t i = 0; i < trace.windows.size(); ++i) errorTerms(object, trace, i);
  replaySimplexes(object, trace);
  search(object, trace);
}

std::vector<StageComparison> SearchComparison::results() const {
  return {terms_.result(), steps_.result(), errors_.result(), winners_.result()};
}

void SearchComparison::errorTerms(const ReferenceObject& object,
                                  const ObjectTrace& trace,
                                  std::size_t window) {
  std::vector<glm::vec3> starts;
  starts.reserve(object.views.size());
  for (int i = 0; i < static_cast<int>(object.views.size()); ++i) {
    starts.push_back(startTranslation(object, i, trace.seed_range_px[window]));
  }
  const auto [expected, actual] = terms_.run(reference_, subject_, [&](StageSet& stages) {
    return stages.probe->errorTerms(object, trace.windows[window], starts, trace.search.error);
  });
  for (std::size_t i = 0; i < expected.size() && i < actual.size(); ++i) {
    terms_.add(termsDifference(expected[i], actual[i]));
  }
  terms_.addMissing(std::abs(static_cast<std::int64_t>(expected.size()) -
                             static_cast<std::int64_t>(actual.size())));
}

/// The reference searches the first window, step by step; each step of the subject starts from its
/// states.
void SearchComparison::replaySimplexes(const ReferenceObject& object, const ObjectTrace& trace) {
  const float max_area = object.maxArea();
  std::vector<float> areas;
  std::vector<SimplexState> states;
  for (int i = 0; i < static_cast<int>(object.views.size()); ++i) {
    const glm::vec3 at = startTranslation(object, i, trace.seed_range_px.front());
    const ReferenceView& view = object.views[static_cast<std::size_t>(i)];
    areas.push_back(areaFactor(trace.search.error.area, view.area_px, max_area));
    states.push_back(simplexStart(at.x, at.y, at.z, trace.search.simplex.step_px));
  }
  while (!allDone(states)) {
    std::vector<glm::vec3> candidates;
    candidates.reserve(states.size());
    for (const SimplexState& state : states) candidates.push_back(candidateOf(state));
    const std::vector<ErrorTerms> terms =
        reference_.probe->errorTerms(object, trace.windows.front(), candidates, trace.search.error);
    std::vector<float> values;
    for (std::size_t i = 0; i < states.size(); ++i) {
      values.push_back(errorValue(terms[i], trace.search.error.lambdaPerPx(), areas[i]));
    }
    const auto [expected, actual] = steps_.run(reference_, subject_, [&](StageSet& stages) {
      return stages.probe->simplexSteps(states, values, trace.search.simplex);
    });
    if (actual.size() != expected.size()) {
      steps_.addMissing(static_cast<std::int64_t>(expected.size()));
      return;
    }
    for (std::size_t i = 0; i < states.size(); ++i)
      steps_.add(stateDifference(expected[i], actual[i]));
    states = expected;
  }
}

void SearchComparison::search(const ReferenceObject& object, const ObjectTrace& trace) {
  const auto [expected, actual] = errors_.run(reference_, subject_, [&](StageSet& stages) {
    std::vector<std::unique_ptr<ResidentScene>> scenes;
    std::vector<const ResidentScene*> windows;
    for (const SceneChannels& window : trace.windows) {
      scenes.push_back(stages.scenes->upload(window));
      windows.push_back(scenes.back().get());
    }
    return stages.search->search(object, windows, trace.seed_range_px, trace.search);
  });
  tallyHypotheses(expected, actual, errors_, winners_);
}

const Hypothesis* winnerOf(const std::vector<Hypothesis>& hypotheses, int window) {
  const Hypothesis* winner = nullptr;
  for (const Hypothesis& hypothesis : hypotheses) {
    if (hypothesis.window != window) continue;
    if (winner == nullptr || hypothesis.error < winner->error) winner = &hypothesis;
  }
  return winner;
}

void tallyHypotheses(const std::vector<Hypothesis>& reference,
                     const std::vector<Hypothesis>& subject,
                     Tally& errors,
                     Tally& winners) {
  constexpr double kSmallError = 1.0e-3;  // a perfect fit of a synthetic view
  const auto gap = [](const Hypothesis& a, const Hypothesis& b) {
    return relativeDifference(
        static_cast<double>(a.error), static_cast<double>(b.error), kSmallError);
  };
  if (reference.size() != subject.size()) {
    errors.addMissing(static_cast<std::int64_t>(std::max(reference.size(), subject.size())));
    return;
  }
  for (std::size_t i = 0; i < reference.size(); ++i) {
    const bool same =
        reference[i].view == subject[i].view && reference[i].window == subject[i].window;
    errors.add(same ? gap(reference[i], subject[i]) : kIncomparable);
  }
  for (int window = 0;; ++window) {
    const Hypothesis* expected = winnerOf(reference, window);
    const Hypothesis* actual = winnerOf(subject, window);
    if (expected == nullptr || actual == nullptr) break;
    const Hypothesis* there = find(reference, actual->view, window);
    const double behind = there == nullptr ? kIncomparable : gap(*expected, *there);
    winners.add(std::max(gap(*expected, *actual), behind));
  }
}

}  // namespace rangepose
