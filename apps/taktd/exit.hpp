#pragma once

namespace takt {

/// Exit codes of taktd, documented in its help text.
enum class Exit : int {
  good = 0,
  refused = 1,
  wrong_use = 2,
  bus_failure = 3,
  node_missing = 4,
  too_late = 5,
  not_stopped = 6,  ///< the ordered stop was not confirmed; this code overrides all others
};

}  // namespace takt
