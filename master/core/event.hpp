#pragma once
#include <array>
#include <cstdint>
#include <type_traits>

#include "eds_parser/table/boot_plan.hpp"
#include "eds_parser/table/time.hpp"
#include "master/core/node_status.hpp"

namespace takt {

/// Why an SDO transfer ended without its data. CiA 301, 7.2.4.
enum class SdoFault : std::uint8_t {
  none,
  aborted_by_device,  ///< abort_code says why
  aborted_by_master,  ///< protocol error of the device; abort_code is what was sent
  timeout,            ///< the device fell silent; 0504 0000 was sent
  too_long,           ///< the answer does not fit into the buffer; 0504 0005 was sent
  cancelled,          ///< the node was reset or the master stops
  no_such_node,       ///< requests: the network file has no such node
  refused,            ///< requests: the master only observes
  no_such_pdo,        ///< PDO requests: the network file has no such PDO of the node
  not_exchanging,     ///< PDO requests: the node is not operational
  lss_failed,         ///< LSS requests: the last LssResult of the reply says why
  lss_refused,        ///< LSS requests: nonsense, or a service that a running master does not offer
  wrong_length,       ///< PDO requests: the RPDO is mapped with another number of bytes
  axes_not_stopped,   ///< NMT requests: obeyed, but some axis was not seen at standstill before
};

/// The one record of a failed boot: all that is needed to explain it. boot_report turns it into
/// text on the front side. Bytes are as on the wire.
struct BootFailure {
  std::uint16_t step = 0;  ///< index into BootPlan::steps
  BootAction action = BootAction::write;
  char letter = 'J';
  SdoFault fault = SdoFault::none;  ///< none: the value was read but is another one
  bool downloading = false;         ///< the failing transfer was a download
  std::uint32_t abort_code = 0;
  ObjectKey object;
  std::uint8_t received_size = 0;  ///< of the last frame of the transfer; 0: nothing came
  std::array<std::uint8_t, 8> received{};
  std::uint8_t sent_size = 0;
  std::array<std::uint8_t, 8> sent{};
  std::uint32_t moved = 0;                  ///< bytes of a long transfer that were through
  std::uint16_t value_size = 0;             ///< of the value that was read
  std::array<std::uint8_t, 8> value{};      ///< its first bytes
  NmtState node_state = NmtState::unknown;  ///< heard last in this boot; unknown: silent
  bool bootup_seen = false;
  std::uint8_t attempts = 0;  ///< uploads of the failing step
  std::uint8_t restarts = 0;  ///< the node restarted so often while it was booted
  bool running = false;       ///< the node was OPERATIONAL and left so
  std::uint16_t emcy = 0;     ///< newest error code that came during this boot, 0 = none
  Time elapsed{};             ///< since the boot began
  Time late{};  ///< how late answers come of requests that have timed out; 0: none has come
  ObjectKey answered{};  ///< the object of an answer that came for another one; index 0: none
};

enum class EventKind : std::uint8_t {
  // nodes
  boot_started,
  boot_done,    ///< value 1: it was already operational and was not reset; detail: ms; bytes: how
                ///< many objects differ and were left alone (2), the first of them (index 2, sub 1)
  boot_failed,  ///< failure; detail: how often in a row by the same cause (told at 1, 2, 4, 8 ...)
  node_state,   ///< value: new NmtState
  heartbeat_lost,    ///< value: ns of silence
  heartbeat_back,    ///< of a node that is only watched; lost ones that are managed boot again
  guarding_lost,     ///< value: ns without a good answer
  guarding_toggle,   ///< the toggle bit of a guarding answer repeats; told when it begins
  bootup_again,      ///< a boot-up message of a node that was ready
  node_replaced,     ///< another serial number than before; value: new, detail: old
  firmware_differs,  ///< from what the device data were taken for; value: Firmware::packed
  no_sdo_block,      ///< its SDO server knows none: all goes by segments until it is reset; value:
                     ///< abort code, 0: it gave no answer; detail: index << 8 | sub
  limit_read,  ///< of a drive, in its boot; value: as the device says, of a range the lower end in
               ///< its upper half; detail: place in LimitsPlan::lines << 8 | LimitVerdict
  program_progress,  ///< value: bytes that the device has taken, detail: of how many
  lss_assigned,      ///< the node had no id and has got it; value: its serial number
  lss_not_assigned,  ///< it was found without id, but did not take it, or (outcome nobody) others
                     ///< were; bytes: op, outcome, error, specific of the LssResult; told when that
                     ///< changes
  unlisted_node,     ///< value: id of a node that is not in the network file (status A)
  network_ready,     ///< all mandatory nodes have booted; the master is operational
  network_late,      ///< mandatory nodes still missing after the boot time; detail: how many
  duplicate_node,    ///< two devices seem to have this id; value: DuplicateSign
  loss_reaction,     ///< value: LossReaction, of which this node was the cause
  mandatory_lost,    ///< a mandatory node was lost; value 1: all are stopped, 0: all are reset
  emcy,  ///< bytes: the eight bytes of the EMCY frame; value: how many before it were not told
  // the cycle
  pdo_missing,      ///< value: TPDO number; told when it begins
  pdo_back,         ///< value: TPDO number
  pdo_late,         ///< value: TPDO number, detail: us after SYNC; told when it begins
  pdo_length,       ///< value: TPDO number, detail: received length
  cycles_missed,    ///< value: how many periods were skipped
  receive_overrun,  ///< value: frames lost by the kernel
  // a SYNC that another device makes
  sync_lost,    ///< value: ns of silence, 0: none has come at all; detail: SyncLoss
  sync_back,    ///< value: ns without it, 0: the first one; detail: SyncLoss
  sync_jump,    ///< its counter; value: received (-1: none), detail: expected; told when it begins
  sync_early,   ///< value: ns after the one before; told when it begins
  sync_period,  ///< it keeps another period than the network file says; value: ns
  // outputs
  command_refused,  ///< value: signal, detail: RefusedBecause
  fallback_begun,   ///< value: signal whose command outlived its time to live
  fallback_ended,   ///< value: signal
  outputs_held,    ///< value: RPDO number that lacks a commanded, safe or seeded value; detail: the
                   ///< signal of the actual position that a limited set-point waits for, plus 1; 0:
                   ///< it waits for none
  limit_exceeded,  ///< a command isn't sent, its node's outputs take their fallback; value: as
                   ///< commanded, raw; detail: signal << 8 | LimitKind; bytes: what was measured
                   ///< and its limit, each a float in SI
  // the bus
  bus_error_passive,
  bus_error_active,
  bus_off,
  bus_recovered,
  send_buffer_full,  ///< ENOBUFS; value: frames not sent
  interface_down,    ///< detail: errno
  interface_up,
  foreign_sync,
  foreign_nmt,       ///< bytes: the command
  duplicate_cob_id,  ///< value: COB-ID seen from somebody else
  // the ordered stop
  axis_not_stopped,  ///< An axis is not confirmed. detail: AxisVerdict, axis << 8, 1 << 16 by
                     ///< differences of 0x6064; value: ns without an answer (silent, lost), else
                     ///< the raw velocity
  still_armed,  ///< the device did not take the write that disarms it; detail: index << 8 | sub,
                ///< value: abort code, 0: not confirmed, negative: ns that it gave no answer
  // the master
  stopping,
  stopped,
};

/// What gave two devices of one id away.
enum class DuplicateSign : std::uint8_t {
  heartbeats,  ///< more heartbeats than one producer sends
  answers,     ///< several answers to one SDO request
};

/// What a limit that a device tells is good for.
enum class LimitVerdict : std::uint8_t {
  good,
  implausible,  ///< it is ignored
};

enum class RefusedBecause : std::uint8_t {
  not_an_output,
  other_session,  ///< the node's outputs belong to another sender
  stale_session,  ///< a daemon session that has ended: a replayed log
  node_not_ready,
  out_of_range,
  observing,
};

/// One thing worth telling. Trivially copyable: made by the bus thread, told by the front thread.
struct Event {
  Time when{};
  std::uint64_t cycle = 0;
  EventKind kind = EventKind::node_state;
  std::uint8_t node = 0;  ///< 0: the bus itself
  std::uint32_t detail = 0;
  std::int64_t value = 0;
  std::array<std::uint8_t, 8> bytes{};
  BootFailure failure{};
};
static_assert(std::is_trivially_copyable_v<Event>);

}  // namespace takt
