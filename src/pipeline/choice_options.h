// What the choice among poses goes by. Each default was chosen on bins of models/tuning.
#pragma once

namespace rangepose {

struct ChoiceOptions {
  double same = 0.05;    ///< poses nearer to each other are one [diameters]
  double rival = 0.5;    ///< share of the pixels of the larger of two poses that both explain, from
                         ///< which on they are for one surface
  double shared = 0.25;  ///< share of its pixels that other chosen poses may explain, too
  double faint = 0.01;   ///< less sure poses are nobody's rivals [confidence]
  double listed = 0.02;  ///< less sure poses cannot be chosen [confidence]
  double turned = 0.2;   ///< from here on turned copies of a pose are tried [confidence]
  double turned_again = 0.25;  ///< and from here on also where that was done for a surer rival
  double found = 0.5;    ///< from here on a part counts as found, and hides others [confidence]
  double sure = 0.75;    ///< from here on its pixels are not searched again [confidence]
  double settled = 0.3;  ///< from here on chosen poses are brought to rest [confidence]
  double free = 0.5;    ///< a turn by a tenth of the diameter is free where it changes what is seen
                        ///< by less [tolerances]
  int free_turns = 24;  ///< of a full turn, which are tried: steps of 15 degrees, so that one is
                        ///< nearly right
  double tie = 3.0;     ///< rivals no farther apart are aligned more closely [log odds]
  double close = 2.0;   ///< model and data this near are as near as they can be [sigmas]
  double at_rest = 0.005;  ///< what aligned poses are off, and more [diameters]
  double slack = 0.5;  ///< a pose may reach so far into the found part that hides it [tolerances]
  double hidden_from = 0.5;  ///< a pose that explains less is not hidden by others: what is left of
                             ///< it fits anything [mean visible areas]
  void check() const;        ///< throws Error naming the bad field
};

}  // namespace rangepose
