// The cells of a run as rows of the gate's tables.
#pragma once

#include <vector>

#include "eval/gate_tables.h"
#include "gate/gate_run.h"

namespace rangepose::gate {

inline constexpr const char* kAllSensors = "all";

/// Of each sensor: each kind of bins, the parts of mixed ones, and all kinds together; at last all
/// sensors.
std::vector<GateRow> gateRows(const std::vector<GateCell>& cells,
                              const std::vector<System>& systems);

/// Of each sensor: each kind and all; at last all sensors. The first system is the one before.
std::vector<GateDifferenceRow> differenceRows(const std::vector<GateCell>& cells,
                                              std::size_t after);

}  // namespace rangepose::gate
