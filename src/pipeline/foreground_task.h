// What parts ask of the foreground they are searched in.
#pragma once

#include <optional>

#include "database/reference_database.h"
#include "stages/foreground.h"

namespace rangepose {

/// For parts of the database; with a bin, of what is inside or above it.
ForegroundTask foregroundTaskFor(const ReferenceDatabase& database,
                                 const std::optional<BinBox>& bin);

}  // namespace rangepose
