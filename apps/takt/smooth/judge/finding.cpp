#include "apps/takt/smooth/judge/finding.hpp"

#include <algorithm>
#include <tuple>

namespace takt::smooth {

const char* name_of(Cause cause) noexcept {
  switch (cause) {
    using enum Cause;
    case no_sync:
      return "no_sync";
    case two_sync_producers:
      return "two_sync_producers";
    case sync_missing:
      return "sync_missing";
    case sync_jitter:
      return "sync_jitter";
    case left_operation:
      return "left_operation";
    case mode_changed:
      return "mode_changed";
    case two_senders:
      return "two_senders";
    case not_synchronous:
      return "not_synchronous";
    case interpolation_period:
      return "interpolation_period";
    case clock_beat:
      return "clock_beat";
    case bus_load:
      return "bus_load";
    case late:
      return "late";
    case early:
      return "early";
    case skipped:
      return "skipped";
    case overwritten:
      return "overwritten";
    case slow_values:
      return "slow_values";
    case value_beat:
      return "value_beat";
    case duplicated:
      return "duplicated";
    case value_skipped:
      return "value_skipped";
    case velocity_jump:
      return "velocity_jump";
    case set_point_ripple:
      return "set_point_ripple";
    case coarse:
      return "coarse";
    case lag_in_group:
      return "lag_in_group";
    case interpolation_unset:
      return "interpolation_unset";
    case feed_forward:
      return "feed_forward";
    case actual_ripple:
      return "actual_ripple";
  }
  return "";
}

void sort_findings(std::vector<Finding>& findings) {
  std::ranges::stable_sort(findings, {}, [](const Finding& finding) {
    return std::tuple{finding.gravity, finding.cause};
  });
}

}  // namespace takt::smooth
