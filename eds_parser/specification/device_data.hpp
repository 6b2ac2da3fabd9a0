#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "eds_parser/dictionary/object_dictionary.hpp"
#include "eds_parser/report/network_report.hpp"
#include "eds_parser/specification/network_spec.hpp"
#include "eds_parser/specification/speed_axis_spec.hpp"
#include "eds_parser/table/bus_plan.hpp"
#include "eds_parser/table/firmware.hpp"

namespace takt {

/// The numbers from `low` to `high`, both included.
struct NumberRange {
  std::uint32_t low = 0;
  std::uint32_t high = 0xFFFF'FFFF;

  constexpr bool contains(std::uint32_t number) const noexcept {
    return number >= low && number <= high;
  }
};

/// The identity of a node as far as it is known before the master reads it.
struct DeviceIdentity {
  std::uint32_t vendor = 0;
  std::uint32_t product = 0;
  std::uint32_t revision = 0;
};

/// The devices of one family, recognized by their identity.
struct DeviceMatch {
  std::uint32_t vendor = 0;  ///< never 0
  NumberRange product;
  NumberRange revision;

  constexpr bool contains(DeviceIdentity identity) const noexcept {
    return vendor == identity.vendor && product.contains(identity.product) &&
           revision.contains(identity.revision);
  }
};

/// The place of a statement in the device data, and its reason, which paraphrases the manual of the
/// manufacturer.
struct DeviceFact {
  SourcePos pos;
  std::string reason;
};

/// How the event timer of a TPDO and the events of this TPDO affect each other.
enum class TimerMeaning : std::uint8_t {
  restarts,    ///< Every transmission restarts the timer, as CiA 301 demands.
  additional,  ///< The timer sends in addition to events, and events do not shift it.
  alone,       ///< While the timer is set, events send nothing.
};

enum class PdoFunction : std::uint8_t { process_data, parameter_channel };

/// The capabilities of the PDOs `numbers` of one direction.
struct PdoRule {
  DeviceFact fact;
  bool is_tpdo = true;
  NumberRange numbers{1, 512};
  std::vector<NumberRange> types;  ///< allowed transmission types; empty means those of CiA 301
  bool without_timer = false;      ///< The event timer must be 0.
  bool without_rtr = false;        ///< The PDO does not support remote requests.
  bool no_more_entries = false;    ///< The mapping takes no more objects than it has by default.
  bool no_gaps = false;            ///< A PDO can be used only together with the PDO before it.
  /// Transmission types with which a TPDO is sent only as the answer to the RPDO of the same
  /// number.
  std::vector<NumberRange> answers;
  PdoFunction function = PdoFunction::process_data;
};

/// The unit and the range of the inhibit time, 0x1800:03.
struct InhibitRule {
  DeviceFact fact;
  std::uint32_t unit_us = 100;
  /// Shortest time, in units of unit_us; the device uses this value for shorter times.
  std::uint32_t least = 0;
  std::uint32_t factory = 0;  ///< default in units of unit_us; 0 means unknown

  constexpr std::uint64_t us(std::uint32_t units) const noexcept {
    return std::uint64_t{units} * unit_us;
  }
};

struct TimerRule {
  DeviceFact fact;
  TimerMeaning meaning = TimerMeaning::restarts;
};

/// The node-IDs that the switches of the device can set.
struct NodeIdRule {
  DeviceFact fact;
  NumberRange ids{1, 127};
};

/// The resolution of 0x1016 and 0x1017. The device rounds times down.
struct HeartbeatRule {
  DeviceFact fact;
  std::uint16_t multiple_of_ms = 1;

  constexpr std::uint32_t kept(std::uint32_t ms) const noexcept { return ms - ms % multiple_of_ms; }
};

/// A value that each boot writes before the values of the network file.
struct ValueEdit {
  DeviceFact fact;
  ObjectKey object;
  std::int64_t value = 0;
};

/// The SDO timeout of an object that answers slowly.
struct TimeoutEdit {
  DeviceFact fact;
  SdoObjectTimeout timeout;
};

/// The behaviour of the device as SYNC producer.
struct SyncRule {
  DeviceFact fact;
  /// First firmware with which the SYNC that the device produces also triggers its own TPDOs.
  std::optional<Firmware> own_tpdos_from;
  /// Index of the object that must hold the same identifier as 0x1005. 0 means that there is none.
  std::uint16_t tx_identifier = 0;
};

/// A difference between an object of the device and its EDS.
struct ObjectEdit {
  DeviceFact fact;
  ObjectKey object;
  bool whole = true;             ///< The edit applies to all sub-indices.
  bool missing = false;          ///< The device does not have the object.
  std::optional<Access> access;  ///< empty if the object is missing
  std::optional<Firmware> from;
  std::optional<Firmware> below;
};

/// An SDO server that the device has at delivery, whether its EDS describes it or not. The node-ID
/// is added to these COB-IDs.
struct SdoServerFact {
  DeviceFact fact;
  std::uint16_t index = 0;  ///< 0x1201..0x127F
  std::uint16_t request = 0;
  std::uint16_t answer = 0;
};

struct BootTweaks {
  DeviceFact fact;
  std::optional<ResetPolicy> reset;
  bool values_after_pdos = false;
  std::uint32_t pause_after_bootup_ms = 0;
  std::uint32_t pause_before_start_ms = 0;
};

/// One entry of the device data: the deviations of a device family from CiA 301 or from its EDS.
struct DeviceData {
  std::string id;      ///< file name without extension: "lenze8400"
  std::string file;    ///< path of the file
  std::string name;    ///< "Lenze 8400 HighLine"
  std::string manual;  ///< source of the facts
  SourcePos pos;
  std::vector<DeviceMatch> matches;  ///< empty if only `device:` of a node selects the entry
  /// The upper half of 0x1018:03 is the main version of the firmware.
  bool revision_is_firmware = false;
  NodeIdRule node_ids;
  HeartbeatRule heartbeat;
  std::vector<ValueEdit> values;
  std::vector<TimeoutEdit> timeouts;
  std::vector<PdoRule> pdos;
  InhibitRule inhibit;
  TimerRule timer;
  SyncRule sync;
  std::vector<ObjectEdit> objects;
  std::vector<SdoServerFact> sdo_servers;
  BootTweaks boot;
  SpeedAxisSpec speed_axis;
  std::vector<EmcyText> emcy;
  std::string on_sync_loss;  ///< behaviour of the outputs when 0x1006 has expired; empty if unknown

  /// Returns the rule of a PDO, or nullptr if the PDO behaves as CiA 301 says.
  const PdoRule* rule(bool is_tpdo, std::uint16_t number) const noexcept;
  /// Returns the file name and the line of a statement: "astraada_drv28.yaml:12".
  std::string place(SourcePos at) const;
  /// Returns the end of a message: ": reason (astraada_drv28.yaml:12, after its manual)".
  std::string cite(const DeviceFact& fact) const;
};

/// Returns the identity from the network file, else from 0x1018 of the device file, else from
/// [DeviceInfo].
DeviceIdentity identity_of(const NodeSpec& node, const ObjectDictionary& dictionary) noexcept;

/// Returns the rules of an entry that depend on the firmware. Returns std::nullopt if no rule
/// depends on it, or if the firmware is unknown to the plan.
std::optional<FirmwarePlan> firmware_plan(const DeviceData& data, std::optional<Firmware> firmware);

/// Returns the entry of a node: the entry that `device:` names, else the first entry that matches
/// the identity of the node. Returns nullptr if there is none.
const DeviceData* find_device_data(std::span<const DeviceData> entries, const NodeSpec& node,
                                   const ObjectDictionary& dictionary, NetworkReport& report);

/// Returns the firmware of a node: `firmware:`, else that of its simulation, else its revision
/// number if the entry says that this is the firmware. Returns std::nullopt if the firmware is
/// unknown.
std::optional<Firmware> firmware_of(const DeviceData* data, const NodeSpec& node,
                                    const ObjectDictionary& dictionary) noexcept;

/// Returns the dictionary with the corrections of the device data for this firmware.
ObjectDictionary with_object_edits(const ObjectDictionary& dictionary, const DeviceData& data,
                                   std::optional<Firmware> firmware);

}  // namespace takt
