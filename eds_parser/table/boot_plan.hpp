#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "eds_parser/table/ids.hpp"
#include "eds_parser/table/time.hpp"

namespace takt {

/// NMT commands of the master. CiA 301, 7.2.8.2.1.
enum class NmtCommand : std::uint8_t {
  start = 1,
  stop = 2,
  enter_preoperational = 128,
  reset_node = 129,
  reset_communication = 130,
};

/// What one step of a boot does. CiA 302-2, but as a flat program: see BootPlan.
enum class BootAction : std::uint8_t {
  nmt,           ///< send `command` to the node
  await_bootup,  ///< boot-up message within `timeout`; where it stays away, go on (probe follows)
  probe,         ///< upload `object` again and again until it answers, for at most `timeout`
  expect,        ///< upload `object`; another value than `value` (under `mask`) fails the boot
  compare,       ///< upload `object`; another value than `value` (under `mask`) sets `differs`
  skip_if_same,  ///< `differs` not set: jump to step `target`. Clears `differs`
  disable_pdo,   ///< download COB-ID `object` = last value read from it | bit 31
  write,         ///< download `value` to `object`
  enable_pdo,    ///< download COB-ID `value`, bit 30 as last read from `object`
  verify,        ///< as expect; the read-back after writing
  write_if_differs,   ///< upload `object`, download `value` only where it differs
  await_heartbeat,    ///< a heartbeat (any state) within `timeout`
  await_guarding,     ///< node guarding begins; the first answer within `timeout`
  await_alive,        ///< keep-alive: a heartbeat (`guarded`: an answer to guarding) within
                      ///< `timeout`; says it OPERATIONAL, go on at `target` without changing it
  await_value,        ///< upload `object` until it is `value` under `mask`, for at most `timeout`
  download_program,   ///< as write, but large; its progress is told
  write_if_changed,   ///< as write, where this boot has written anything
  read_serial,        ///< upload `object`, to know the device again; may be missing
  read_firmware,      ///< upload `object`, to compare it with NodePlan::firmware; may be missing
  read_limit,         ///< upload `object`, a limit of a drive, see DeviceLimit; may be missing
  await_operational,  ///< the node reports OPERATIONAL within `timeout` (heartbeat or SDO-silent
                      ///< wait)
  pause,              ///< wait for `timeout`
};

/// One step. Every wait has a deadline: `timeout` is the limit of each SDO transfer of the step, or
/// of the wait itself.
struct BootStep {
  BootAction action = BootAction::write;
  char letter = 'J';  ///< error status of CiA 302-2 (A..O) when the step fails
  ObjectKey object{};
  std::vector<std::byte> value{};    ///< little endian, as it goes onto the wire
  std::uint32_t mask = 0xFFFF'FFFF;  ///< for values up to 4 bytes
  NmtCommand command = NmtCommand::start;
  std::uint16_t target = 0;
  char unread_letter = 0;    ///< compare, expect: `object` can't be read; 0: as `letter`
  char running_letter = 0;   ///< compare: differs on a node that was left OPERATIONAL; 0: goes on
  bool guarded = false;      ///< await_alive: asks by guarding
  bool may_restart = false;  ///< the device may restart in this step
  /// The object may be missing (0602 0000, 0609 0011) when `value` is all zero; abort codes that
  /// devices give for a redundant write are then taken as "already so".
  bool optional = false;
  Time timeout{};
  std::string purpose{};   ///< "vendor id", "TPDO1 mapping entry 2: 6064:00 Position actual value"
  std::string eds_note{};  ///< what the EDS says of it, quoted when the step fails; may be empty
};

/// How one node comes up: a linear program, run by the boot runner for each node by itself.
struct BootPlan {
  std::vector<BootStep> steps;
};

}  // namespace takt
