#include "core/error.h"

namespace rangepose::detail {

void failCheck(const char* expression, const std::string& message) {
  throw Error(message + " [" + expression + "]");
}

}  // namespace rangepose::detail
