#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <string_view>

#include "eds_parser/values/pdo_number.hpp"
#include "master/explain/boot_remedy.hpp"

namespace takt {
namespace {

struct Setting {
  std::uint16_t index;
  std::string_view key;      ///< key of the network file
  std::string_view without;  ///< what the user can write to boot without the setting
};

constexpr std::array settings{
    Setting{0x1005, "sync_cob_id", "switch SYNC off (`sync_period: 0`)"},
    Setting{0x1006, "sync_period", "choose a SYNC period that the device accepts"},
    Setting{0x1007, "sync_window", "drop this key"},
    Setting{0x100C, "guard_time", "write `guard_time: 0`; the node is then not monitored"},
    Setting{0x100D, "life_time_factor",
            "drop this key; the device then does not notice the loss of the master"},
    Setting{0x1010, "store_configuration",
            "drop this key; the master then configures the device at each boot"},
    Setting{0x1011, "restore_configuration", "drop this key"},
    Setting{0x1014, "emcy_cob_id", "drop this key; EMCY then keeps its COB-ID"},
    Setting{0x1015, "emcy_inhibit_time", "drop this key"},
    Setting{0x1016, "heartbeat_consumer",
            "write `heartbeat_consumer: false`; the device then does not notice the loss of the "
            "master"},
    Setting{0x1017, "heartbeat_producer",
            "give the period that the device has, or write `heartbeat_producer: 0`; the node is "
            "then not monitored by heartbeat"},
    Setting{0x1019, "sync_overflow", "drop this key"},
    Setting{0x1020, "configuration_date",
            "drop this key; the master then compares the device at each boot"},
    Setting{0x1029, "error_behavior", "drop this key"},
};

std::string_view pdo_key(ObjectKey object) noexcept {
  constexpr std::string_view keys[] = {"", "cob_id", "transmission", "inhibit_time",
                                       "", "",       "sync_start"};
  if (object.sub == 5) return object.index < 0x1800 ? "event_deadline" : "event_timer";
  return object.sub < std::size(keys) ? keys[object.sub] : "";
}

std::string against_refused_pdo(ObjectKey object) {
  const std::string pdo =
      fmt::format("{}{}", object.index < 0x1800 ? "RPDO" : "TPDO", (object.index & 0x1FFU) + 1);
  if (object.sub == 1) {
    return fmt::format(
        "the device does not let {0} be switched off or moved to another COB-ID, so its mapping "
        "can't be changed either: leave `cob_id` and `mapping` of {0} out, so that the settings of "
        "the device are used",
        pdo);
  }
  const std::string_view key = pdo_key(object);
  if (key.empty()) return {};
  return fmt::format(
      "the device does not accept this `{0}` of {1}: look up the allowed values in its manual, or "
      "leave `{0}` out",
      key, pdo);
}

}  // namespace

std::string against_refused_setting(const NodePlan& node, const BootFailure& failure) {
  if (!failure.downloading) return {};
  if (is_pdo_communication(failure.object.index)) return against_refused_pdo(failure.object);
  const auto found = std::ranges::find(settings, failure.object.index, &Setting::index);
  if (found == settings.end()) return {};
  return fmt::format(
      "`{0}` sets {1}: look up which values the device accepts (`takt sdo read {2} {1}` shows the "
      "present value), or {3}",
      found->key, to_string(failure.object), node.id.value(), found->without);
}

}  // namespace takt
