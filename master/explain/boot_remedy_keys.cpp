#include "master/explain/boot_remedy_keys.hpp"

#include <algorithm>
#include <array>
#include <string_view>

namespace takt {
namespace {

struct Setting {
  std::uint16_t index;
  std::string_view key;      ///< key of the network file
  std::string_view without;  ///< what the user can write to do without the setting
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

constexpr bool is_communication(std::uint16_t index) noexcept {
  return (index >= 0x1400 && index <= 0x15FF) || (index >= 0x1800 && index <= 0x19FF);
}

std::string_view pdo_key(ObjectKey object) noexcept {
  switch (object.sub) {
    case 1:
      return "cob_id";
    case 2:
      return "transmission";
    case 3:
      return "inhibit_time";
    case 5:
      return object.index < 0x1800 ? "event_deadline" : "event_timer";
    case 6:
      return "sync_start";
    default:
      return "";
  }
}

std::string against_refused_pdo(ObjectKey object) {
  const std::string pdo =
      (object.index < 0x1800 ? "RPDO" : "TPDO") + std::to_string((object.index & 0x1FFU) + 1);
  if (object.sub == 1) {
    return "the device does not let " + pdo +
           " be switched off or moved to another COB-ID, so its mapping can't be changed either: "
           "leave `cob_id` and `mapping` of " +
           pdo + " out, so that the settings of the device are used";
  }
  const std::string key{pdo_key(object)};
  if (key.empty()) return {};
  return "the device does not accept this `" + key + "` of " + pdo +
         ": look up the allowed values in its manual, or leave `" + key + "` out";
}

}  // namespace

std::string against_refused_setting(const NodePlan& node, const BootFailure& failure) {
  if (!failure.downloading) return {};
  if (is_communication(failure.object.index)) return against_refused_pdo(failure.object);
  const auto found = std::ranges::find(settings, failure.object.index, &Setting::index);
  if (found == settings.end()) return {};
  return "`" + std::string{found->key} + "` sets " + to_string(failure.object) +
         ": look up which values the device accepts (`takt sdo read " +
         std::to_string(int{node.id.value()}) + " " + to_string(failure.object) +
         "` shows the present value), or " + std::string{found->without};
}

}  // namespace takt
