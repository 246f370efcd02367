#include "compare/tally.h"

namespace rangepose {
namespace {

struct NamedTolerance {
  const char* stage;
  StageTolerance tolerance;
};

// Image stages work on floats in one fixed order without contraction, so both paths must agree to
// the last bit. What follows sums in an order of its own, or branches on such sums. "Seen" is what
// llvmpipe and the host differ by at most on scans of elbows and prisms and on a rendered heap,
// with 256 and 1,024 views.
constexpr NamedTolerance kTolerances[] = {
    // Isolated.
    // Mask and depth without lost pixels. Planes and noise are sums in another order, 1e-10 of what
    // they are: a pixel whose height is the tolerance to that may fall to either side.
    {"foreground", {"", 0.0, 1.0e-5}},
    {"background", {"mm", 1.0e-6, 0.0}},  // noise, and how far off the planes are
    {"resample", {"px", 0.0, 0.0}},
    {"median", {"px", 0.0, 0.0}},
    {"edges", {"", 0.0, 0.0}},
    {"edt", {"px", 0.0, 0.0}},  // squares of whole numbers: exact in float
    // One root: correctly rounded there (seen 0), up to 3 ulp of at most 32 px on other devices.
    {"distance", {"px", 6.0e-6, 0.0}},
    {"patches", {"", 0.0, 0.0}},
    {"prepare", {"px", 6.0e-6, 0.0}},  // resample to distance in one chain, as the search uses it
    // The same few thousand floats, added in another order; seen 6e-5 where few of them count.
    {"error terms", {"relative", 1.0e-4, 0.0}},
    // Seen 0; 4 ulp of coordinates below 1000 px where a division by three is not exact.
    {"simplex steps", {"px", 2.5e-4, 0.0}},
    // Seen 1e-5. An ulp of an error sum may turn a branch; that simplex then stops elsewhere within
    // its spread.
    {"search errors", {"relative", 1.0e-3, 0.01}},
    {"search winners", {"relative", 1.0e-3, 0.0}},  // another view wins only where both are as good
    // Rasterisers disagree on the borders of triangles, whose corners GL moves by up to 1/256 px:
    // seen 0.03 % of the pixels in the outline, 0.3 % in the normals of a finely meshed part, and
    // 0.003 mm in depth.
    {"surface outline", {"", 0.0, 0.01}},
    {"surface depth", {"mm", 0.05, 0.01}},
    {"surface normals", {"", 1.0e-4, 0.02}},
    // The same sums of floats in another order: a few roundings of depths of some 500 mm, unless a
    // point finds another partner for it. Seen 8e-5 mm and 3e-8.
    {"alignment", {"mm", 1.0e-3, 0.01}},
    {"verdict", {"", 1.0e-6, 0.0}},
    // The surfaces are those of each path; see above for what they differ by.
    {"surface alignment", {"mm", 0.5, 0.05}},
    {"surface verdict", {"", 0.01, 0.05}},
    // Chained.
    {"whole foreground", {"", 0.0, 1.0e-5}},
    {"scene", {"px", 6.0e-6, 0.0}},
    {"scene patches", {"", 0.0, 0.0}},
    {"starts", {"px", 1.0e-3, 0.0}},  // a mean range is added up in doubles
    {"windows", {"px", 6.0e-6, 0.0}},
    {"rough errors", {"relative", 1.0e-3, 0.01}},
    {"rough winners", {"relative", 1.0e-3, 0.0}},
    // Seen 0.013 mm, 0.028 degrees and 0.0005 of score, all of it from the few border pixels of the
    // surfaces that refinement takes its points from. Its fixed number of iterations itself leaves
    // about 0.1 mm.
    {"pose position", {"mm", 0.05, 0.0}},
    {"pose rotation", {"deg", 0.1, 0.0}},
    {"pose score", {"", 0.005, 0.0}},
};

}  // namespace

StageTolerance toleranceOf(const std::string& stage) {
  const auto* const found = std::find_if(std::begin(kTolerances),
                                         std::end(kTolerances),
                                         [&](const NamedTolerance& t) { return stage == t.stage; });
  RP_CHECK(found != std::end(kTolerances), "no tolerance is known for stage " + stage);
  return found->tolerance;
}

Tally::Tally(const std::string& stage, const std::string& path) : tolerance_(toleranceOf(stage)) {
  result_.stage = stage;
  result_.path = path;
  result_.unit = tolerance_.unit;
  result_.tolerance = tolerance_.each;
  result_.allowed_share = tolerance_.share;
}

void Tally::add(double difference) {
  if (!std::isfinite(difference)) difference = kIncomparable;
  ++result_.total;
  result_.differing += difference > tolerance_.each ? 1 : 0;
  result_.max_difference = std::max(result_.max_difference, difference);
  sum_ += difference;
}

void Tally::addMissing(std::int64_t count) {
  if (count <= 0) return;
  result_.total += count;
  result_.differing += count;
  result_.max_difference = kIncomparable;
  sum_ += kIncomparable * static_cast<double>(count);
}

void Tally::addTimes(double reference_ms, double path_ms) {
  result_.reference_ms += reference_ms;
  result_.path_ms += path_ms;
}

void Tally::addImages(const Image<float>& reference, const Image<float>& subject) {
  addImages(reference, subject, [](float a, float b) {
    return std::abs(static_cast<double>(a) - static_cast<double>(b));
  });
}

StageComparison Tally::result() const {
  StageComparison result = result_;
  const double total = static_cast<double>(std::max<std::int64_t>(1, result.total));
  result.mean_difference = sum_ / total;
  result.within = static_cast<double>(result.differing) <= tolerance_.share * total;
  return result;
}

std::int64_t surplus(std::size_t a, std::size_t b) {
  return std::abs(static_cast<std::int64_t>(a) - static_cast<std::int64_t>(b));
}

double relativeDifference(double a, double b, double floor) {
  return std::abs(a - b) / std::max(std::abs(a), floor);
}

}  // namespace rangepose
