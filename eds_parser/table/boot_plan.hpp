#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "eds_parser/values/ids.hpp"
#include "eds_parser/values/time.hpp"

namespace takt {

/// NMT commands of the master. CiA 301, 7.2.8.2.1.
enum class NmtCommand : std::uint8_t {
  start = 1,
  stop = 2,
  enter_preoperational = 128,
  reset_node = 129,
  reset_communication = 130,
};

/// Returns the object with the quick stop option code (INTEGER16) of an axis, counted from 0. CiA
/// 402-2.
constexpr ObjectKey quick_stop_option(unsigned axis) noexcept { return axis_object(axis, 0x605A); }
constexpr bool is_quick_stop_option(ObjectKey object) noexcept {
  return object.index >= 0x605A && (object.index - 0x605A) % 0x800 == 0 && object.sub == 0;
}

/// The action of one step of a boot. It follows CiA 302-2, but as a flat program; see BootPlan.
enum class BootAction : std::uint8_t {
  nmt,               ///< send `command` to the node
  await_bootup,      ///< wait `timeout` for the boot-up message; go on without it (a probe follows)
  probe,             ///< upload `object` repeatedly until the node answers, for at most `timeout`
  expect,            ///< upload `object`; the boot fails if it differs from `value` (under `mask`)
  compare,           ///< upload `object`; set `differs` if it differs from `value` (under `mask`)
  skip_if_same,      ///< jump to step `target` unless `differs` is set, then clear `differs`
  disable_pdo,       ///< download COB-ID `object` = last value read from it | bit 31
  write,             ///< download `value` to `object`
  enable_pdo,        ///< download COB-ID `value`, bit 30 as last read from `object`
  verify,            ///< as `expect`; used to read back after writing
  write_if_differs,  ///< upload `object`, download `value` only if it differs
  await_heartbeat,   ///< wait `timeout` for a heartbeat (any state)
  await_guarding,    ///< begin node guarding; wait `timeout` for the first answer
  await_alive,       ///< keep-alive: wait `timeout` for a heartbeat (`guarded`: a guarding answer);
                     ///< if the node reports OPERATIONAL, jump to `target` and do not change it
  await_value,       ///< upload `object` until it is `value` under `mask`, for at most `timeout`
  download_program,  ///< as `write`, for a large value; its progress is reported
  write_if_changed,  ///< as `write`, but only if this boot has written anything
  read_serial,       ///< upload `object` to recognise the device later; it may be missing
  read_firmware,     ///< upload `object` to compare it with NodePlan::firmware; it may be missing
  read_limit,        ///< upload `object`, a limit of a drive (see DeviceLimit) or its quick stop
                     ///< option code; it may be missing
  await_operational,  ///< wait `timeout` for a heartbeat with OPERATIONAL; go on without it if the
                      ///< node has no heartbeat
  pause,              ///< wait for `timeout`
};

/// One step of a boot. Every wait has a deadline: `timeout` limits each SDO transfer of the step,
/// or the wait itself.
struct BootStep {
  BootAction action = BootAction::write;
  char letter = 'J';  ///< error status of CiA 302-2 (A..O) when the step fails
  ObjectKey object{};
  std::vector<std::byte> value{};    ///< little endian, as sent on the wire
  std::uint32_t mask = 0xFFFF'FFFF;  ///< mask for values up to 4 bytes
  NmtCommand command = NmtCommand::start;
  std::uint16_t target = 0;
  char unread_letter = 0;    ///< compare, expect: status if `object` can't be read; 0 = `letter`
  char running_letter = 0;   ///< compare: status if it differs (node left OPERATIONAL); 0 = go on
  bool guarded = false;      ///< await_alive: the master uses node guarding
  bool may_restart = false;  ///< the device may restart in this step
  /// The object may be missing (abort codes 0602 0000, 0609 0011) when `value` is all zero. An
  /// abort code that devices return for a redundant write then counts as success.
  bool optional = false;
  Time timeout{};
  std::string purpose{};   ///< "vendor id", "TPDO1 mapping entry 2: 6064:00 Position actual value"
  std::string eds_note{};  ///< note of the EDS on the object, quoted on failure; may be empty
};

/// The boot of one node as a linear program. The boot runner executes it for each node separately.
struct BootPlan {
  std::vector<BootStep> steps;
};

}  // namespace takt
