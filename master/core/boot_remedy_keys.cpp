#include "master/core/boot_remedy_keys.hpp"

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
    Setting{0x1005, "sync_cob_id", "leave SYNC out (`sync_period: 0`)"},
    Setting{0x1006, "sync_period", "choose a SYNC period that it takes"},
    Setting{0x1007, "sync_window", "drop it"},
    Setting{0x100C, "guard_time", "write `guard_time: 0`, then the node is not watched"},
    Setting{0x100D, "life_time_factor", "drop it, then the device does not miss the master"},
    Setting{0x1010, "store_configuration", "drop it, then the device is configured at each boot"},
    Setting{0x1011, "restore_configuration", "drop it"},
    Setting{0x1014, "emcy_cob_id", "drop it, then EMCYs keep their identifier"},
    Setting{0x1015, "emcy_inhibit_time", "drop it"},
    Setting{0x1016, "heartbeat_consumer",
            "write `heartbeat_consumer: false`, then the device does not notice that the master is "
            "gone"},
    Setting{0x1017, "heartbeat_producer",
            "give the period that the device has, or write `heartbeat_producer: 0`, then the node "
            "is not watched by heartbeat"},
    Setting{0x1019, "sync_overflow", "drop it"},
    Setting{0x1020, "configuration_date", "drop it, then the device is compared at each boot"},
    Setting{0x1029, "error_behavior", "drop it"},
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
           " be switched off or moved, and without that its mapping can't be changed either: leave "
           "`cob_id` and `mapping` of " +
           pdo + " out, so that the device's own are used";
  }
  const std::string key{pdo_key(object)};
  if (key.empty()) return {};
  return "the device does not take this `" + key + "` of " + pdo +
         ": look up in its manual which it takes, or leave `" + key + "` out";
}

}  // namespace

std::string against_refused_setting(const NodePlan& node, const BootFailure& failure) {
  if (!failure.downloading) return {};
  if (is_communication(failure.object.index)) return against_refused_pdo(failure.object);
  const auto found = std::ranges::find(settings, failure.object.index, &Setting::index);
  if (found == settings.end()) return {};
  return "`" + std::string{found->key} + "` governs " + to_string(failure.object) +
         ": look up which values the device takes (`takt sdo read " +
         std::to_string(int{node.id.value()}) + " " + to_string(failure.object) +
         "` shows the present one), or " + std::string{found->without};
}

}  // namespace takt
