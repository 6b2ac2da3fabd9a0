#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "eds_parser/network_report.hpp"
#include "eds_parser/network_spec.hpp"
#include "eds_parser/object_dictionary.hpp"
#include "eds_parser/table/bus_plan.hpp"
#include "eds_parser/table/firmware.hpp"

namespace takt {

/// From `low` to `high`, both included.
struct NumberRange {
  std::uint32_t low = 0;
  std::uint32_t high = 0xFFFF'FFFF;

  constexpr bool contains(std::uint32_t number) const noexcept {
    return number >= low && number <= high;
  }
};

/// What is known of the identity of a node before it is asked.
struct DeviceIdentity {
  std::uint32_t vendor = 0;
  std::uint32_t product = 0;
  std::uint32_t revision = 0;
};

/// Devices of one family, told by their identity.
struct DeviceMatch {
  std::uint32_t vendor = 0;  ///< never 0
  NumberRange product;
  NumberRange revision;

  constexpr bool contains(DeviceIdentity identity) const noexcept {
    return vendor == identity.vendor && product.contains(identity.product) &&
           revision.contains(identity.revision);
  }
};

/// Where an entry says something, and why: the maker's manual in our words.
struct DeviceFact {
  SourcePos pos;
  std::string reason;
};

/// What event timer and events of a TPDO have to do with each other.
enum class TimerMeaning : std::uint8_t {
  restarts,    ///< every transmission restarts it; CiA 301
  additional,  ///< it sends besides events, which do not shift it
  alone,       ///< while it is set, events send nothing
};

enum class PdoFunction : std::uint8_t { process_data, parameter_channel };

/// What the PDOs `numbers` of one direction can do.
struct PdoRule {
  DeviceFact fact;
  bool is_tpdo = true;
  NumberRange numbers{1, 512};
  std::vector<NumberRange> types;    ///< transmission types; empty: those of CiA 301
  bool without_timer = false;        ///< the event timer has to be 0
  bool without_rtr = false;          ///< no remote requests
  bool no_more_entries = false;      ///< the mapping takes no more objects than by default
  bool no_gaps = false;              ///< used only together with the one before
  std::vector<NumberRange> answers;  ///< types of which a TPDO only answers the RPDO of its number
  PdoFunction function = PdoFunction::process_data;
};

/// How 0x1800:03 counts.
struct InhibitRule {
  DeviceFact fact;
  std::uint32_t unit_us = 100;
  std::uint32_t least = 0;    ///< units; the device takes shorter times as this
  std::uint32_t factory = 0;  ///< units; 0: not known
};

struct TimerRule {
  DeviceFact fact;
  TimerMeaning meaning = TimerMeaning::restarts;
};

/// Node ids that its switches can have.
struct NodeIdRule {
  DeviceFact fact;
  NumberRange ids{1, 127};
};

/// How 0x1016 and 0x1017 count: the device rounds down.
struct HeartbeatRule {
  DeviceFact fact;
  std::uint16_t multiple_of_ms = 1;

  constexpr std::uint32_t kept(std::uint32_t ms) const noexcept { return ms - ms % multiple_of_ms; }
};

/// Written at boot, before what the network file asks for.
struct ValueEdit {
  DeviceFact fact;
  ObjectKey object;
  std::int64_t value = 0;
};

/// An object that takes its time.
struct TimeoutEdit {
  DeviceFact fact;
  SdoObjectTimeout timeout;
};

/// As SYNC producer.
struct SyncRule {
  DeviceFact fact;
  std::optional<Firmware> own_tpdos_from;  ///< its own SYNC triggers its TPDOs from here on
  std::uint16_t tx_identifier = 0;  ///< object that has to be the identifier of 0x1005; 0: none
};

/// The device has an object otherwise than its EDS says.
struct ObjectEdit {
  DeviceFact fact;
  ObjectKey object;
  bool whole = true;             ///< all sub-indices
  std::optional<Access> access;  ///< none: the object is missing
  std::optional<Firmware> from;
  std::optional<Firmware> below;
};

/// An SDO server that the device comes with, on these COB-IDs + node id, whether its EDS tells of
/// it or not.
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

struct EmcyMeaning {
  std::uint16_t code = 0;
  std::string text;
};

/// One entry of the device data: what a device family does otherwise than CiA 301 or its EDS say.
struct DeviceData {
  std::string id;      ///< stem of its file: "lenze8400"
  std::string file;    ///< as found
  std::string name;    ///< "Lenze 8400 HighLine"
  std::string manual;  ///< where its facts come from
  SourcePos pos;
  std::vector<DeviceMatch> matches;   ///< none: only `device:` of a node chooses the entry
  bool revision_is_firmware = false;  ///< 0x1018:03: main version in the upper half
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
  std::vector<EmcyMeaning> emcy;
  std::string on_sync_loss;  ///< what its outputs do when 0x1006 has run out; empty: not known

  /// The rule of a PDO; nullptr: as CiA 301.
  const PdoRule* rule(bool is_tpdo, std::uint16_t number) const noexcept;
  /// "astraada_drv28.yaml:12".
  std::string place(SourcePos at) const;
  /// ": reason (astraada_drv28.yaml:12, after its manual)", the end of a message.
  std::string cite(const DeviceFact& fact) const;
};

/// By the network file; else by 0x1018 of the device file, else by its [DeviceInfo].
DeviceIdentity identity_of(const NodeSpec& node, const ObjectDictionary& dictionary) noexcept;

/// What of an entry depends on the firmware; none: nothing does, or the plan knows no firmware.
std::optional<FirmwarePlan> firmware_plan(const DeviceData& data, std::optional<Firmware> firmware);

/// The entry of a node: the one that `device:` names, else the first one that its identity matches;
/// nullptr where there is none.
const DeviceData* find_device_data(std::span<const DeviceData> entries, const NodeSpec& node,
                                   const ObjectDictionary& dictionary, NetworkReport& report);

/// Firmware of a node: `firmware:`, that of its simulation, or its revision number where the entry
/// says so; none: unknown.
std::optional<Firmware> firmware_of(const DeviceData* data, const NodeSpec& node,
                                    const ObjectDictionary& dictionary) noexcept;

/// The dictionary as the device has it.
ObjectDictionary with_object_edits(const ObjectDictionary& dictionary, const DeviceData& data,
                                   std::optional<Firmware> firmware);

}  // namespace takt
