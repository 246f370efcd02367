// Layout of the search state: one column a view, seven rows.
// Twin of SimplexState in src/stages/simplex_core.h.
const int kRowReflected = 4;
const int kRowCandidate = 5;
const int kRowCounters = 6;  // phase, iterations, highest, lowest

const int kVertex3 = 3;
const int kReflect = 4;
const int kExpand = 5;
const int kContract = 6;
const int kShrink0 = 7;
const int kDone = 11;
