#include "io/length_unit.h"

#include <fmt/format.h>

#include "core/error.h"
#include "io/file_bytes.h"

namespace rangepose {

LengthUnit parseLengthUnit(std::string_view text) {
  if (text == "mm") return LengthUnit::kMillimetre;
  if (text == "m") return LengthUnit::kMetre;
  if (text == "inch") return LengthUnit::kInch;
  throw Error(fmt::format("unit \"{}\" is not known; use mm, m or inch", oneLine(text)));
}

double millimetresPer(LengthUnit unit) {
  switch (unit) {
    case LengthUnit::kMillimetre:
      return 1.0;
    case LengthUnit::kMetre:
      return 1000.0;
    case LengthUnit::kInch:
      return 25.4;
  }
  throw Error("unit: value outside of LengthUnit");
}

}  // namespace rangepose
