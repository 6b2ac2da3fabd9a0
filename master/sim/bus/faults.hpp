#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "eds_parser/values/ids.hpp"
#include "eds_parser/values/time.hpp"

namespace takt::sim {

/// Kind of a fault. A fault lasts from Fault::at until Fault::until; a kind marked `once` is an
/// event at Fault::at.
enum class FaultKind : std::uint8_t {
  // the wire
  loss,          ///< frames of `node` are on the wire but no node receives them (`probability`)
  duplicate,     ///< frames of `node` arrive twice (`probability`), which can also happen on a real
                 ///< CAN bus
  delay,         ///< frames of `node` wait up to `time` before they are offered to the bus
  error_frames,  ///< frames of `node` are destroyed and repeated (`probability`)
  babble,        ///< an extra node sends `cob_id` with `value` every `time` (0: back to back)
  // a device
  power_off,       ///< the node is without power
  drift,           ///< the node's clock runs `ppm` fast
  mute_sdo,        ///< the SDO server does not answer; if `object` is set, only for this object
  slow_sdo,        ///< each answer of the SDO server comes up to `time` later
  refuse_object,   ///< SDO access to `object` is aborted with `abort_code`
  refuse_write,    ///< only writing `object` is aborted with `abort_code`
  ignore_write,    ///< writing `object` is confirmed, but changes nothing
  override_value,  ///< `object` reads as `value`, for example another vendor or product
  late_bootup,     ///< the boot-up message comes `time` later than normal
  no_bootup,       ///< the device sends no boot-up message
  no_heartbeat,    ///< the device sends no heartbeat
  no_guarding,     ///< the device does not answer guarding requests
  stuck_toggle,    ///< guarding answers repeat their toggle bit
  bootup_storm,    ///< the device sends a boot-up message every `time`
  self_start,      ///< the node goes to OPERATIONAL by itself after its boot-up
  no_start,        ///< the node ignores NMT start
  preop_only,      ///< objects below 0x2000 can be written in PRE-OPERATIONAL only
  fixed_mapping,   ///< the PDO mapping is read-only
  lss_silent,      ///< the device does not answer LSS requests
  lss_no_store,    ///< LSS store configuration fails with error code 2
  mute_pdo,        ///< the device sends no TPDO
  device_error,    ///< once: the device reports EMCY `emcy_code`; a drive goes to Fault
  reset,           ///< once: the device resets by itself
  bus_off,         ///< once: the controller of `node` goes bus-off; without a node, the master's
                   ///< controller
  // the master's own machine
  stall_master,    ///< the master's process does not run
  interface_down,  ///< the master's interface is down
};

/// One fault. Only the fields that the comment of its `kind` names have an effect.
struct Fault {
  FaultKind kind = FaultKind::loss;
  std::optional<NodeId> node{};  ///< empty means every device; for faults of the wire, every sender
                                 ///< including the master
  Time at{};
  Time until = never;
  double probability = 0.0;  ///< probability for each frame, 0..1
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

/// Returns the name of a kind, such as `refuse_object`, as fault files and the quirks of a device
/// use it.
std::string_view name(FaultKind kind) noexcept;
std::optional<FaultKind> fault_kind(std::string_view name) noexcept;

}  // namespace takt::sim
