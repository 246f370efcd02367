#include "pipeline/choice_options.h"

#include "core/error.h"

namespace rangepose {

void ChoiceOptions::check() const {
  const auto isShare = [](double value) { return value >= 0.0 && value <= 1.0; };
  RP_CHECK(same > 0.0 && at_rest > 0.0, "choice: same and at_rest must be above 0");
  RP_CHECK(isShare(rival) && isShare(shared), "choice: rival and shared must lie in 0..1");
  RP_CHECK(isShare(faint) && isShare(listed) && isShare(turned) && isShare(found) &&
               isShare(sure) && isShare(settled) && isShare(turned_again),
           "choice: confidences must lie in 0..1");
  RP_CHECK(faint <= listed && listed <= found && found <= sure,
           "choice: faint, listed, found and sure must rise");
  RP_CHECK(tie >= 0.0 && close > 0.0 && slack >= 0.0 && hidden_from >= 0.0,
           "choice: tie, close, slack and hidden_from must not be negative");
  RP_CHECK(free >= 0.0 && free_turns >= 2,
           "choice: free must not be negative and free_turns at least 2");
}

}  // namespace rangepose
