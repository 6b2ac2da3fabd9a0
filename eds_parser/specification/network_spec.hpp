#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "eds_parser/report/source.hpp"
#include "eds_parser/specification/speed_axis_spec.hpp"
#include "eds_parser/table/bus_plan.hpp"
#include "eds_parser/table/firmware.hpp"
#include "eds_parser/table/mechanics.hpp"
#include "eds_parser/table/run_options.hpp"
#include "eds_parser/table/sdo_access.hpp"
#include "eds_parser/values/ids.hpp"

namespace takt {

/// A value of the network file and its place in the file. `given` is false for a default.
template <class T>
struct Sourced {
  T value{};
  SourcePos pos{};
  bool given = false;

  const T& operator*() const noexcept { return value; }
  const T* operator->() const noexcept { return &value; }
  T value_or(T fallback) const { return given ? value : fallback; }
};

/// One entry of `mapping: [{index: 0x6041, sub_index: 0}]`.
struct MappingSpec {
  ObjectKey object{};
  std::optional<std::uint8_t> bits{};  ///< empty means the width of the object
  SourcePos pos;
};

/// Addressing of a multiplexed PDO: by destination or by source. CiA 301, 7.2.3.
enum class Mpdo : std::uint8_t { none, dam, sam };

/// One entry of `tpdo: {1: {...}}` or `rpdo:`; the directions are those of the device. Members that
/// are not given keep the value of the EDS.
struct PdoSpec {
  std::uint16_t number = 1;  ///< 1..512
  SourcePos pos;
  Sourced<bool> enabled{.value = true};
  /// COB-ID with the flags of bits 29..31 as in 0x1800:01. Empty means `auto`.
  Sourced<std::optional<std::uint32_t>> cob_id;
  Sourced<std::uint8_t> transmission;
  Sourced<std::uint16_t> inhibit_time;    ///< 100 us
  Sourced<std::uint16_t> event_timer;     ///< ms
  Sourced<std::uint16_t> event_deadline;  ///< ms
  Sourced<std::uint8_t> sync_start;
  Sourced<std::uint32_t> poll_ms{};     ///< period of the remote requests of the master
  Sourced<std::uint16_t> poll_syncs{};  ///< a remote request at every n-th SYNC
  Sourced<bool> drop_late{};            ///< `late: drop`
  Sourced<bool> on_request{};           ///< `request: true`
  Sourced<Mpdo> mpdo{};
  Sourced<std::vector<MappingSpec>> mapping;
};

/// One entry of `sdo: [{index: 0x6083, sub_index: 0, value: 10000}]`. The boot writes the entries
/// in this order.
struct SdoSpec {
  ObjectKey object;
  std::variant<std::int64_t, double, std::string, std::vector<std::byte>> value;
  SourcePos pos;
  SourcePos value_pos;
  std::optional<std::string> quoted{};  ///< text as written, if it is in quotes
  bool again = false;                   ///< The object is repeated on purpose.

  /// Returns nullptr if the value is no integer.
  const std::int64_t* integer() const noexcept { return std::get_if<std::int64_t>(&value); }
};

/// SI value = sign * counts * scale + offset.
struct UnitSpec {
  Sourced<double> scale{.value = 1.0};
  double offset = 0.0;
  int sign = 1;
  std::string unit;
  SourcePos pos;
};

/// Groups of objects that share a unit.
enum class Quantity : std::uint8_t { position, velocity, acceleration, torque };

struct ObjectUnitSpec {
  ObjectKey object;
  UnitSpec unit;
};

/// `units:` of a node.
struct UnitsSpec {
  std::optional<UnitSpec> position;
  std::optional<UnitSpec> velocity;
  std::optional<UnitSpec> acceleration;
  std::optional<UnitSpec> torque;
  std::vector<ObjectUnitSpec> objects;  ///< `objects: [{index, sub_index, scale, unit}]`
  /// The section has errors or is misspelled. A missing unit is then not reported as another error.
  bool has_errors = false;

  const std::optional<UnitSpec>& of(Quantity quantity) const noexcept {
    return *std::array{&position, &velocity, &acceleration,
                       &torque}[static_cast<std::size_t>(quantity)];
  }
};

/// The lowest and the highest value.
struct RangeSpec {
  double low = 0.0;
  double high = 0.0;
};

/// The limits of the commands to an axis, in the units of `units:`.
struct AxisLimitsSpec {
  Sourced<RangeSpec> position;
  Sourced<double> velocity;
  Sourced<double> acceleration;
  Sourced<double> jerk;
  Sourced<double> following_error;  ///< largest following error in a motion that taktd runs
  Sourced<double> step;  ///< largest change of a position set-point from one cycle to the next
  Sourced<double> torque;
  Sourced<double> modulo;  ///< length of a turn, after which the position begins again
};

struct AxisOverrideSpec {
  std::uint8_t axis = 1;
  SourcePos pos;
  AxisLimitsSpec limits;
};

/// One entry of `objects: [{index, sub_index, min, max, step}]`.
struct ObjectLimitSpec {
  ObjectKey object;
  SourcePos pos;
  Sourced<double> min;
  Sourced<double> max;
  Sourced<double> step;
};

/// `limits:` of a node.
struct LimitsSpec {
  AxisLimitsSpec all;  ///< limits of every axis of the device
  /// `axes: {2: {...}}`; each given limit overrides the same limit of `all`.
  std::vector<AxisOverrideSpec> axes;
  std::vector<ObjectLimitSpec> objects;
};

/// The torque that the motions of an axis need, in the units of `units:`.
struct AxisFeedForwardSpec {
  Sourced<double> torque_per_acceleration;
  Sourced<double> torque_per_velocity;
};

struct AxisFeedForwardOverrideSpec {
  std::uint8_t axis = 1;
  SourcePos pos;
  AxisFeedForwardSpec feed_forward;
};

/// `feed_forward:` of a node.
struct FeedForwardSpec {
  bool given = false;
  SourcePos pos;
  AxisFeedForwardSpec all;  ///< values for every axis of the device
  /// `axes: {2: {...}}`; each given value overrides the same value of `all`.
  std::vector<AxisFeedForwardOverrideSpec> axes;

  /// Returns what applies to an axis, which counts from 1.
  AxisFeedForwardSpec of(std::uint8_t axis) const {
    AxisFeedForwardSpec found = all;
    for (const auto& [number, at, own] : axes) {
      if (number != axis) continue;
      if (own.torque_per_acceleration.given) {
        found.torque_per_acceleration = own.torque_per_acceleration;
      }
      if (own.torque_per_velocity.given) found.torque_per_velocity = own.torque_per_velocity;
    }
    return found;
  }
};

/// The homing of an axis, in the units of `units:`. The boot writes only the values that are given.
struct AxisHomingSpec {
  Sourced<bool> required{.value = true};  ///< An absolute motion needs homing first.
  Sourced<std::int8_t> method;            ///< 0x6098
  Sourced<double> speed_switch;           ///< 0x6099:01
  Sourced<double> speed_zero;             ///< 0x6099:02
  Sourced<double> acceleration;           ///< 0x609A
  Sourced<double> offset;                 ///< 0x607C
  Sourced<std::uint32_t> timeout;         ///< ms
};

struct AxisHomingOverrideSpec {
  std::uint8_t axis = 1;
  SourcePos pos;
  AxisHomingSpec homing;
};

/// `homing:` of a node.
struct HomingSpec {
  bool given = false;
  SourcePos pos;
  AxisHomingSpec all;  ///< values for every axis of the device
  /// `axes: {2: {...}}`; each given value overrides the same value of `all`.
  std::vector<AxisHomingOverrideSpec> axes;

  /// Returns what applies to an axis, which counts from 1.
  AxisHomingSpec of(std::uint8_t axis) const {
    AxisHomingSpec found = all;
    const auto take = [](auto& value, const auto& own) {
      if (own.given) value = own;
    };
    for (const auto& [number, at, own] : axes) {
      if (number != axis) continue;
      take(found.required, own.required);
      take(found.method, own.method);
      take(found.speed_switch, own.speed_switch);
      take(found.speed_zero, own.speed_zero);
      take(found.acceleration, own.acceleration);
      take(found.offset, own.offset);
      take(found.timeout, own.timeout);
    }
    return found;
  }
};

/// The reaction of outputs when their command is too old.
enum class FallbackPolicy : std::uint8_t { quick_stop, hold, zero, safe, disable };

struct TimeoutSpec {
  Sourced<FallbackPolicy> fallback;
  Sourced<std::uint32_t> after;         ///< ms; 0 means no limit
  Sourced<std::uint32_t> after_cycles;  ///< 0 means no limit
};

/// The reset that the master sends to a node before it communicates with the node.
enum class ResetPolicy : std::uint8_t {
  communication,
  node,
  none,
  /// `communication`, unless the node is OPERATIONAL; then the master leaves the node as it is.
  keep_alive,
};

struct SimSpec {
  std::string model;
  Sourced<Firmware> firmware;
  std::vector<std::string> quirks;
  /// Positions are in the unit of `units: position`; a `turn` of 0 means the default.
  std::optional<MechanicsTable> mechanics{};
};

struct NodeSpec {
  std::string name;
  SourcePos pos;
  Sourced<std::uint8_t> id;  ///< 1..127 if given
  Sourced<std::string> dcf;
  Sourced<std::string> dcf_path;

  // The expected identity. 0 means that the value is not checked.
  Sourced<std::uint32_t> device_type;
  Sourced<std::uint32_t> vendor_id;
  Sourced<std::uint32_t> product_code;
  Sourced<std::uint32_t> revision_number;
  Sourced<std::uint32_t> serial_number;
  /// Entry of the device data, or "none"; if not given, the identity selects the entry.
  Sourced<std::string> device;
  Sourced<Firmware> firmware;

  Sourced<bool> lss;  ///< The node gets its node-ID by LSS if it has none.
  /// The node stores the node-ID that it gets by LSS.
  Sourced<bool> lss_store{.value = true};

  Sourced<bool> boot{.value = true};
  Sourced<bool> mandatory;
  Sourced<ResetPolicy> reset;
  Sourced<std::uint8_t> restore;            ///< sub-index of 0x1011; 0 means no restore
  Sourced<std::uint8_t> store;              ///< sub-index of 0x1010; 0 means no store
  Sourced<std::uint32_t> software_version;  ///< 0x1F55; 0 means that the version is not checked
  Sourced<std::string> software_file;
  std::vector<std::byte> program;           ///< content of `software_file`
  Sourced<std::string> configuration_file;  ///< concise DCF; `sdo` contains its values
  /// 0x1F26 and 0x1F27: days since 1984-01-01, ms since midnight. An empty date is derived from the
  /// content.
  Sourced<std::optional<std::uint32_t>> configuration_date;
  Sourced<std::uint32_t> configuration_time;
  Sourced<std::uint32_t> boot_timeout_ms;
  Sourced<std::uint32_t> sdo_timeout_ms;
  Sourced<std::uint32_t> reboot_delay_ms;
  Sourced<std::uint32_t> reboot_delay_max_ms;
  Sourced<SdoBlockUse> sdo_block;
  Sourced<SdoChannel> sdo_channel;
  std::vector<SdoObjectTimeout> sdo_timeouts;

  /// The device watches the heartbeat of the master.
  Sourced<bool> heartbeat_consumer{.value = true};
  Sourced<std::uint16_t> heartbeat_producer;  ///< ms
  Sourced<double> heartbeat_multiplier;
  Sourced<std::uint16_t> guard_time;         ///< ms; 0x100C
  Sourced<std::uint8_t> life_time_factor;    ///< 0x100D; the device watches the master
  Sourced<std::uint8_t> retry_factor;        ///< The master watches the device.
  std::vector<SdoSpec> error_behavior;       ///< entries of 0x1029 by sub-index
  Sourced<std::uint32_t> emcy_cob_id;        ///< 0x1014
  Sourced<std::uint16_t> emcy_inhibit_time;  ///< 0x1015, 100 us
  /// 0x1012 with its flags; bit 31 means that the device consumes TIME.
  Sourced<std::uint32_t> time_cob_id{};
  Sourced<LossReaction> on_loss;
  Sourced<std::string> group;

  Sourced<std::string> profile;  ///< "cia402", "cia401", "none"; if not given, the EDS decides
  UnitsSpec units;
  LimitsSpec limits;
  HomingSpec homing;
  FeedForwardSpec feed_forward;
  SpeedAxisSpec speed_axis;
  TimeoutSpec on_timeout;
  std::vector<SdoSpec> safe_values;
  SimSpec sim;
  std::vector<PdoSpec> tpdos;
  std::vector<PdoSpec> rpdos;
  /// `rpdo` has errors or is misspelled. A missing output is then not reported as another error.
  bool has_rpdo_errors = false;
  std::vector<SdoSpec> sdo;

  /// Returns the first entry of `sdo` for the object, or nullptr if there is none.
  const SdoSpec* written(ObjectKey object) const noexcept {
    const auto found = std::ranges::find(sdo, object, &SdoSpec::object);
    return found == sdo.end() ? nullptr : &*found;
  }
  /// Returns the value of that entry, or nullptr if it is no integer or there is no entry.
  const std::int64_t* written_integer(ObjectKey object) const noexcept {
    const SdoSpec* entry = written(object);
    return entry == nullptr ? nullptr : entry->integer();
  }
  /// Returns the entry of `tpdo` or `rpdo`, or nullptr if there is none.
  const PdoSpec* pdo(bool is_tpdo, std::uint16_t number) const noexcept {
    const auto& list = is_tpdo ? tpdos : rpdos;
    const auto found = std::ranges::find(list, number, &PdoSpec::number);
    return found == list.end() ? nullptr : &*found;
  }
};

struct MasterSpec {
  SourcePos pos;
  Sourced<std::uint8_t> node_id{.value = 127};
  Sourced<std::uint32_t> baudrate_kbit{.value = 1000};
  Sourced<std::uint32_t> sync_period_us;
  Sourced<std::uint32_t> sync_window_us;
  Sourced<std::uint8_t> sync_overflow;
  Sourced<std::uint32_t> sync_cob_id{.value = 0x80};
  Sourced<std::string> sync_source;        ///< "master", "external" or the name of a node
  Sourced<std::uint32_t> sync_timeout_us;  ///< timeout of a SYNC that another device produces
  Sourced<SyncLoss> on_sync_loss{.value = SyncLoss::fallback};
  /// Cycle of the process image if there is no SYNC.
  Sourced<std::uint32_t> cycle_us{.value = 10'000};
  Sourced<std::uint16_t> heartbeat_producer{.value = 100};  ///< ms; 0 means no heartbeat
  Sourced<double> heartbeat_multiplier;
  /// The master watches the heartbeat of the nodes.
  Sourced<bool> heartbeat_consumer{.value = true};
  Sourced<std::uint32_t> time_period_ms;  ///< period of TIME; 0 means that the master produces none
  Sourced<std::uint32_t> time_cob_id{.value = 0x100};  ///< same format as in 0x1012
  Sourced<bool> start_nodes{.value = true};
  Sourced<bool> start{.value = true};  ///< The master becomes OPERATIONAL by itself.
  Sourced<bool> start_all_nodes;
  Sourced<bool> reset_all_nodes;  ///< applies if a mandatory node is lost
  Sourced<bool> stop_all_nodes;   ///< applies if a mandatory node is lost
  Sourced<std::uint32_t> boot_time_ms;
  Sourced<std::uint16_t> nmt_inhibit_time;  ///< 100 us
  Sourced<std::uint32_t> stop_timeout_ms;   ///< if not given, the value is derived from the drives
  Sourced<StopDisarm> stop_disarm{.value = StopDisarm::sdo};
  Sourced<std::uint16_t> service_frames;  ///< largest number of SDO and NMT frames in one cycle
};

struct BusSpec {
  Sourced<std::string> name;
  Sourced<std::string> interface;
};

/// The content of a network file as written. The data of the devices are not part of it.
struct NetworkSpec {
  std::string file;
  BusSpec bus;
  Sourced<std::string> dcf_path;
  Sourced<double> heartbeat_multiplier{.value = 3.0};
  Sourced<std::uint8_t> retry_factor{.value = 3};  ///< default for guarding
  MasterSpec master;
  RealtimeOptions realtime;
  Sourced<std::uint32_t> receive_window_us;
  LcmOptions lcm;
  RecordingOptions recording;   ///< The folder is as written in the file.
  std::vector<NodeSpec> nodes;  ///< in the order of the file
};

}  // namespace takt
