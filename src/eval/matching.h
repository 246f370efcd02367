// Which estimate belongs to which true pose: greedily by score, as the BOP challenges do (Hodan et
// al., "BOP Challenge 2020 on 6D Object Localization", ECCVW 2020).
#pragma once

#include <vector>

#include "core/image.h"

namespace rangepose {

/// Errors of the estimates of one object in one image (rows, y) against its true poses (columns,
/// x).
using PairErrors = Image<double>;

/// Surfaces that are less than this apart look the same [diameters].
inline constexpr double kLookApart = 0.01;

/// All estimates of one object in one image, measured against the truth.
struct ObjectErrors {
  int scene_id = 0;
  int im_id = 0;
  int obj_id = 0;
  std::vector<double> scores;             ///< of the estimates, descending: the rows of the tables
  std::vector<double> visible_fractions;  ///< of the true poses, 0..1: their columns
  int targets = 0;              ///< how many true poses BOP asks for: the most visible ones
  PairErrors mssd;              ///< [diameters]; at and above 0.5 only a lower bound
  PairErrors mspd_px;           ///< as in an image 640 px wide; at and above 50 only a lower bound
  std::vector<PairErrors> vsd;  ///< one for each tau of VsdOptions, 0..1
  PairErrors unlike;            ///< unlikeness() at kLookApart, 0..1
  PairErrors rotation_rad;      ///< modulo symmetry; only where mssd is below 0.1, else infinite
  PairErrors translation_mm;    ///< of the nearest symmetric copy; likewise
};

inline constexpr int kUnmatched = -1;

/// The true pose that each estimate is matched with, or kUnmatched. Row by row (by falling score)
/// an estimate takes the one with the smallest error below `threshold` that is still free.
/// `eligible`, if not empty, has a flag for each true pose that may be taken; rows from
/// `max_estimates` on (0: no limit) take none.
std::vector<int> matchGreedily(const PairErrors& errors,
                               double threshold,
                               const std::vector<bool>& eligible = {},
                               int max_estimates = 0);

/// Flags the `count` largest values; of equal ones the first.
std::vector<bool> largest(const std::vector<double>& values, int count);

}  // namespace rangepose
