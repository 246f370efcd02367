// What the alignment of candidates goes by: one struct a step. Each default was chosen on bins of
// models/tuning.
#pragma once

namespace rangepose {

/// One round of alignment with points of the candidates' own views.
struct CoarseRound {
  int iterations;
  int search_steps;        ///< see IcpOptions
  double first_reach;      ///< of the first iteration [diameters]
  double last_tolerances;  ///< reach of the last iteration [tolerances]
  double rim_reach;        ///< see IcpOptions [diameters]
  int rim_steps;           ///< see IcpOptions
  double judged;           ///< what is explained is judged with that share of the tolerance
};

/// Rounds of rendering and alignment of what is visible.
struct FineRounds {
  int rounds;          ///< at most
  int points;          ///< of each surface
  double first_reach;  ///< of the first round [tolerances]
  double last_reach;   ///< of the last iteration of each round [tolerances]
  double rim_reach;    ///< see IcpOptions [diameters]
};

struct AlignOptions {
  // A few steps with few points tell which of many hypotheses are worth more.
  CoarseRound all{4, 1, 0.20, 6.4, 0.12, 6, 1.0};
  CoarseRound many{8, 1, 0.11, 2.0, 0.12, 6, 0.7};
  CoarseRound few{8, 2, 0.06, 1.5, 0.08, 16, 0.6};
  int view_points = 220;      ///< of a view, in the last of these rounds
  double coarse_rims = 0.2;   ///< weight of rims: where a pose is far off, an end of the data is a
                              ///< surer guide than what happens to lie near its faces
  double glanced = 0.15;      ///< rank below which a coarse pose is not rendered, the best excepted
  int fine_iterations = 12;   ///< of a round with a rendered surface
  double first_reach = 6.0;   ///< of the first such round [tolerances]
  double later_reach = 1.5;   ///< of later ones [tolerances]
  double nearly_right = 4.0;  ///< with no more reach partners are looked for nearby [tolerances]
  double hopeless = -1.5;     ///< no long alignment makes such a pose right [log odds]
  FineRounds rest{8, 900, 3.0, 1.0, 0.05};  ///< until a pose rests
  FineRounds tie{16, 900, 1.5, 0.5, 0.08};  ///< for poses that the image hardly tells apart
  double tie_still = 1e-5;  ///< such a pose rests when it moves by less in a round [diameters]
  double worse = 3.0;       ///< what an alignment makes worse than that stays as it was [log odds]
  int settle_iterations = 4;  ///< with every pixel
  int settle_rounds = 2;      ///< of rendering
  int settle_px = 400;        ///< a side of a surface: of more, every second pixel is enough
  double held = 1e-3;         ///< a twin that moves by more is free to move [diameters]
  void check() const;         ///< throws Error naming the bad field
};

}  // namespace rangepose
