// The unit of files that carry none: meshes and clouds.
#pragma once

#include <string_view>

namespace rangepose {

enum class LengthUnit { kMillimetre, kMetre, kInch };

/// "mm", "m" or "inch"; anything else throws Error.
LengthUnit parseLengthUnit(std::string_view text);

/// Length of one unit [mm].
double millimetresPer(LengthUnit unit);

}  // namespace rangepose
