#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <type_traits>

#include "eds_parser/table/boot_plan.hpp"
#include "eds_parser/values/time.hpp"
#include "master/core/node_status.hpp"

namespace takt {

/// The reason why an SDO transfer ended without its data. CiA 301, 7.2.4.
enum class SdoFault : std::uint8_t {
  none,
  aborted_by_device,  ///< The device has aborted the transfer; abort_code says why.
  aborted_by_master,  ///< The device has broken the protocol; abort_code is the code that the
                      ///< master has sent.
  timeout,   ///< The device has not answered in time; the master has sent abort code 0504 0000.
  too_long,  ///< The answer does not fit into the buffer; the master has sent abort code 0504 0005.
  cancelled,       ///< The node was reset, the master stops, or the sender has cancelled it.
  no_such_node,    ///< Requests: the network file has no such node.
  refused,         ///< Requests: the master only observes.
  no_such_pdo,     ///< PDO requests: the network file has no such PDO of the node.
  not_exchanging,  ///< PDO requests: the node is not OPERATIONAL.
  lss_failed,      ///< LSS requests: the last LssResult of the reply says why.
  lss_refused,   ///< LSS requests: the request is malformed, or a running master does not offer the
                 ///< service.
  wrong_length,  ///< PDO requests: the RPDO is mapped with another number of bytes.
  axes_not_stopped,  ///< NMT requests: the command was sent, but some axis was not seen at
                     ///< standstill before.
};

/// The record of a failed boot, with all data that are needed to explain the failure.
/// boot_report.hpp makes a text of the record in the front thread. Bytes are in the order in which
/// they are sent on the bus.
struct BootFailure {
  std::uint16_t step = 0;  ///< index into BootPlan::steps
  BootAction action = BootAction::write;
  char letter = 'J';                ///< error status of CiA 302-2
  SdoFault fault = SdoFault::none;  ///< `none` means that the value was read and differs
  bool downloading = false;         ///< the failed transfer was a download
  std::uint32_t abort_code = 0;
  ObjectKey object;
  /// Size of the last frame of the device in the transfer; 0 means no frame came.
  std::uint8_t received_size = 0;
  std::array<std::uint8_t, 8> received{};
  std::uint8_t sent_size = 0;  ///< size of the last frame of the master in the transfer
  std::array<std::uint8_t, 8> sent{};
  std::uint32_t moved = 0;                  ///< bytes of a long transfer that were transferred
  std::uint16_t value_size = 0;             ///< size of the value that was read, in bytes
  std::array<std::uint8_t, 8> value{};      ///< first bytes of the value that was read
  NmtState node_state = NmtState::unknown;  ///< the newest state in this boot; `unknown` means that
                                            ///< the node was silent
  bool bootup_seen = false;                 ///< a boot-up message came during this boot
  std::uint8_t attempts = 0;                ///< number of uploads that the failed step has tried
  std::uint8_t restarts = 0;                ///< how often the node has restarted during this boot
  bool running = false;                     ///< the node was OPERATIONAL and was left in that state
  std::uint16_t emcy = 0;  ///< newest EMCY error code during this boot, 0 means none
  Time elapsed{};          ///< time since the boot began
  Time late{};  ///< longest time until the answer to a request that had timed out; 0 means that no
                ///< such answer came
  /// Time without a frame of the SDO server when the step failed, at most the time since the step
  /// began.
  Time quiet{};
  bool empty_answer = false;  ///< the device has sent an SDO frame without any byte
  /// The object of an answer that did not belong to the request. Empty if there was none.
  std::optional<ObjectKey> answered{};
  /// The node was sent to PRE-OPERATIONAL twice for the step, and refused the write both times
  /// because of its state.
  bool preop_again = false;
};

/// Kind of an event. It defines the meaning of Event::value, Event::detail and Event::bytes.
enum class EventKind : std::uint8_t {
  // nodes
  boot_started,
  boot_done,  ///< value: 1 if the node was already OPERATIONAL and was not reset; detail: duration
              ///< of the boot in ms; bytes: number of objects that differ from the plan and were
              ///< not changed (2 bytes), and the first of these objects (index 2 bytes, sub-index 1
              ///< byte)
  boot_failed,       ///< `failure` is valid; detail: number of failures in a row by the same cause
                     ///< (reported at 1, 2, 4, 8 ...)
  node_state,        ///< value: the new NmtState
  heartbeat_lost,    ///< value: ns of silence
  heartbeat_back,    ///< The heartbeat of a node that is only watched is back. Managed nodes boot
                     ///< again instead.
  guarding_lost,     ///< value: ns without a valid answer
  guarding_toggle,   ///< The toggle bit of a guarding answer repeats; reported when that begins.
  bootup_again,      ///< A node that was ready has sent a boot-up message. value: 1 if the master
                     ///< does not boot it now, because of an ordered stop or an NMT stop
  node_replaced,     ///< The node has another serial number than before; value: new, detail: old.
  firmware_differs,  ///< The firmware differs from the one for which the device data were made;
                     ///< value: Firmware::packed.
  no_sdo_block,  ///< The SDO server supports no block transfer; all transfers are segmented until
                 ///< the node is reset. value: abort code, 0 if the server gave no answer; detail:
                 ///< index << 8 | sub-index
  limit_read,    ///< The boot of a drive has read a limit. value: the limit as the device gives
                 ///< it; for a range, the upper half of the value is the lower end of the range;
                 ///< detail: index into LimitsPlan::lines << 8 | LimitVerdict
  program_progress,  ///< value: bytes that the device has accepted, detail: size of the program in
                     ///< bytes
  lss_assigned,  ///< The node had no node-ID and has received it by LSS; value: its serial number.
  lss_not_assigned,  ///< The node was found without node-ID but did not accept the assigned
                     ///< node-ID, or (outcome `nobody`) only other devices without node-ID have
                     ///< answered. bytes: op, outcome, error, specific of the LssResult; reported
                     ///< when these bytes change.
  unlisted_node,   ///< value: node-ID of a node that is not in the network file (CiA 302-2, status
                   ///< A)
  network_ready,   ///< All mandatory nodes have booted, and the master is operational.
  network_late,    ///< Mandatory nodes are still missing after the boot time; detail: their number.
  duplicate_node,  ///< Two devices seem to have this node-ID; value: DuplicateSign.
  loss_reaction,   ///< value: the LossReaction that the loss of this node has caused
  mandatory_lost,  ///< A mandatory node was lost; value: 1 if all nodes are stopped, 0 if all are
                   ///< reset.
  emcy,  ///< bytes: data of the EMCY frame, detail: their number; value: number of EMCYs before
         ///< this one that were not reported
  // the cycle
  pdo_missing,      ///< value: TPDO number; reported when it begins
  pdo_back,         ///< value: TPDO number
  pdo_late,         ///< value: TPDO number, detail: us after SYNC; reported when it begins
  pdo_length,       ///< value: TPDO number, detail: received length
  cycles_missed,    ///< value: number of skipped periods, detail: MissedBecause
  receive_overrun,  ///< value: frames lost by the kernel
  // SYNC of another device
  sync_lost,    ///< value: ns of silence, 0 if no SYNC has come at all; detail: SyncLoss
  sync_back,    ///< value: ns without SYNC, 0 for the first SYNC; detail: SyncLoss
  sync_jump,    ///< The counter jumps. value: received counter (-1 if the frame has none), detail:
                ///< expected counter; reported when it begins.
  sync_early,   ///< value: ns after the previous SYNC; reported when it begins
  sync_period,  ///< The period differs from that of the network file; value: measured period in ns.
  // outputs
  fallback_begun,  ///< value: signal whose command has expired; bytes: pack_limit(), or 0
  fallback_ended,  ///< value: signal
  outputs_held,    ///< An RPDO is not sent because one of its signals has neither a command nor a
                   ///< safe value nor the value of its feedback. value: RPDO number; detail: 1
                   ///< plus the index of the actual position for which a limited set-point waits;
                   ///< 0 means that no set-point waits
  limit_exceeded,  ///< A command is not sent, and the outputs of its node take their fallback.
                   ///< value: the raw command; detail: signal << 8 | LimitKind, and held_set_point;
                   ///< bytes: the measured value and its limit, each a float in SI units
  // CAN controller and interface
  bus_error_passive,
  bus_error_active,
  bus_off,
  bus_recovered,
  send_buffer_full,  ///< ENOBUFS; value: number of frames that were not sent, detail: SendFailure
  interface_down,    ///< detail: errno
  interface_up,
  foreign_sync,
  foreign_nmt,       ///< bytes: the command
  duplicate_cob_id,  ///< value: COB-ID of the master's frames that another device also uses
  // the ordered stop
  axis_not_stopped,  ///< The stop of an axis is not confirmed. detail: AxisVerdict | axis << 8 | 1
                     ///< << 16 if the velocity comes from differences of 0x6064; value: ns without
                     ///< an answer (silent, lost), abort code (refused), else the raw velocity
  still_armed,       ///< The device did not accept a write that ends its supervision of the master.
                     ///< detail: index << 8 | sub-index; value: abort code, 0 if not confirmed,
                     ///< negative: ns without an answer
  drive_coasts,  ///< The boot of a drive has found that its quick stop disables it at once. value:
                 ///< axis, counted from 0
  // the master
  stopping,
  stopped,
};

/// The sign by which the master has noticed that two devices use one node-ID.
enum class DuplicateSign : std::uint8_t {
  heartbeats,  ///< More heartbeats arrive than one producer sends.
  answers,     ///< One SDO request gets several answers.
};

/// The result of the check of a limit that was read from a device.
enum class LimitVerdict : std::uint8_t {
  good,
  implausible,  ///< The limit is ignored.
};

/// The reason why the CAN interface accepted no more frames. It is Event::detail of
/// `send_buffer_full`.
enum class SendFailure : std::uint32_t {
  queue_too_short,  ///< The bus is healthy, but txqueuelen is below the number of frames that one
                    ///< cycle sends.
  nobody_acknowledges,  ///< The controller is error passive: cable, bit rate, or no other node.
  /// The controller is bus-off.
  bus_off,
};

/// The reason why SYNC periods were skipped. It is Event::detail of `cycles_missed`.
enum class MissedBecause : std::uint32_t {
  late,          ///< The bus thread did not run in time.
  wire_blocked,  ///< The controller is bus-off, or no node acknowledges the previous SYNC.
  sent_late,     ///< The bus thread was late with the previous SYNC, which was not on the wire yet.
  not_seen,  ///< The previous SYNC was not seen on the wire, and the controller reports no error.
};

/// Bit of Event::detail of `limit_exceeded`. It means that the command itself contained no
/// set-point: by enabling the axis or changing its mode, it would have made an earlier set-point
/// effective.
inline constexpr std::uint32_t held_set_point = 0x80;

/// One event. The bus thread creates it and the front thread reports it, so it is trivially
/// copyable.
struct Event {
  Time when{};
  std::uint64_t cycle = 0;
  EventKind kind = EventKind::node_state;
  std::uint8_t node = 0;  ///< node-ID, 0 means the bus itself
  std::uint32_t detail = 0;
  std::int64_t value = 0;
  std::array<std::uint8_t, 8> bytes{};
  BootFailure failure{};
};
static_assert(std::is_trivially_copyable_v<Event>);

}  // namespace takt
