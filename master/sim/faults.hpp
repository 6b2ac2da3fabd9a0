#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "eds_parser/table/ids.hpp"
#include "eds_parser/table/time.hpp"

namespace takt::sim {

/// What goes wrong. Each lasts from Fault::at until Fault::until; those marked `once` only begin.
enum class FaultKind : std::uint8_t {
  // the wire
  loss,          ///< frames of `node` are on the wire but nobody takes them (`probability`)
  duplicate,     ///< frames of `node` arrive twice (`probability`); CAN does that by itself
  delay,         ///< frames of `node` wait up to `time` before they are offered to the bus
  error_frames,  ///< frames of `node` are destroyed and repeated (`probability`)
  babble,        ///< somebody sends `cob_id` with `value` every `time` (0: back to back)
  // a device
  power_off,       ///< the node is without power
  drift,           ///< the node's clock runs `ppm` fast
  mute_sdo,        ///< the SDO server does not answer (`object` set: for this object only)
  slow_sdo,        ///< each answer of the SDO server comes up to `time` later
  refuse_object,   ///< SDO access to `object` is aborted with `abort_code`
  refuse_write,    ///< the same for writing only
  ignore_write,    ///< writing `object` is confirmed, but changes nothing
  override_value,  ///< `object` reads as `value`: another vendor, another product
  late_bootup,     ///< the boot-up message comes `time` later than usual
  no_bootup,       ///< no boot-up message
  no_heartbeat,    ///< no heartbeat
  no_guarding,     ///< no answer to guarding requests
  stuck_toggle,    ///< guarding answers repeat their toggle bit
  bootup_storm,    ///< a boot-up message every `time`
  self_start,      ///< the node goes to OPERATIONAL by itself after its boot-up
  no_start,        ///< NMT start is not obeyed
  preop_only,      ///< objects below 0x2000 can be written in PRE-OPERATIONAL only
  fixed_mapping,   ///< PDO mapping is read-only
  lss_silent,      ///< no answer to LSS
  lss_no_store,    ///< LSS store fails with error 2
  mute_pdo,        ///< no TPDO is sent
  device_error,    ///< once: the device reports EMCY `emcy_code`; a drive goes to Fault
  reset,           ///< once: the device resets by itself
  bus_off,         ///< once: the controller of `node` goes bus-off (no node: the master's)
  // the master's own machine
  stall_master,    ///< the master's process does not run
  interface_down,  ///< the master's interface is down
};

/// One thing that goes wrong. Only the fields that `kind` names are looked at.
struct Fault {
  FaultKind kind = FaultKind::loss;
  std::optional<NodeId> node{};  ///< none: every device; of the wire: every sender, the master too
  Time at{};
  Time until = never;
  double probability = 0.0;  ///< 0..1 for each frame
  Time time{};
  int ppm = 0;
  CobId cob_id{};
  std::optional<ObjectKey> object{};
  std::uint32_t abort_code = 0;
  std::uint16_t emcy_code = 0;
  std::vector<std::byte> value{};
};

/// A schedule of faults, in any order.
using Faults = std::vector<Fault>;

/// `refuse_object`; as written in fault files and as quirk of a device.
std::string_view name(FaultKind kind) noexcept;
std::optional<FaultKind> fault_kind(std::string_view name) noexcept;

}  // namespace takt::sim
