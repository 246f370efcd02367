// How sure a pose is: one sum of what speaks for and against it, and the probability that follows.
//
// A pose is judged from one rendering (check_core.h). What was seen of it becomes a few terms, each
// bounded, each with the sensor's noise in it through the tolerance of the check; their weighted
// sum is the logarithm of the odds that the pose is right. The weights are fitted by
// `rangepose_fit` to checked poses of the gate's fitting bins, all sensors and wear together
// (docs/evidence.md).
#pragma once

#include <array>
#include <cstddef>

#include "stages/check_core.h"

namespace rangepose {

/// What the evidence is made of, in the order of its weights.
enum class EvidenceTerm : std::size_t {
  kOne,           ///< 1: the odds before anything was seen
  kThrough,       ///< log of the share in front of the data: the sensor saw through the part
  kBuried,        ///< what lies just behind nearer data, as a share of that and of what agrees
  kRelief,        ///< relief up to kEnoughRelief
  kMoreRelief,    ///< relief beyond that
  kUnseenRelief,  ///< relief that this sensor would show of the whole part and that is not seen
  kEnds,          ///< share of the outline that was seen at which the data ends, too
  kVisible,  ///< log of the surface that agrees, as a share of what the object shows on average
  kOutside,  ///< share of the surface that lies where no part can be (enclosure.h)
};
inline constexpr std::size_t kEvidenceTerms = 9;
using EvidenceTerms = std::array<double, kEvidenceTerms>;

/// Relief from which on a part and a smooth surface are hardly confused: half of what errors leave.
inline constexpr double kEnoughRelief = 0.7;

/// What is known of a pose but for its check.
struct EvidenceContext {
  double mean_visible_mm2 = 1.0;  ///< mean area of the object's views [mm^2]
  double outside = 0.0;           ///< Enclosure::outsideShare(), 0..1
};

/// Short names, as in tables.
const char* nameOf(EvidenceTerm term);

EvidenceTerms evidenceTerms(const CheckResult& check, const EvidenceContext& context);

/// One of the terms, which changes when found parts are known to hide what was buried.
double buriedTerm(const CheckResult& check);

/// The fitted weights.
const EvidenceTerms& evidenceWeights();

/// Log odds that a pose is right. Bounded by what was seen: of `inner_px` pixels inside of the
/// surface, which are a ninth as many observations, as neighbours err together, the odds are at
/// most as many to 4.
double logOddsOf(const EvidenceTerms& terms, double inner_px);

/// The probability of those odds, 0..1.
double probabilityOf(double log_odds);

}  // namespace rangepose
