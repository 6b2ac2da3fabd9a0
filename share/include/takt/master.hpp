#pragma once
/// @file
/// A CANopen master inside the program: boots the devices of a bus, exchanges its image in each
/// cycle, and stops in order. It needs no daemon and no LCM.
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <expected>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <takt/network.hpp>
#include <vector>

namespace takt {

/// Options of a Master.
struct MasterOptions {
  /// The bus to run on:
  /// * `can0`: a CAN interface of Linux (SocketCAN). It must be up, with the bit rate of the bus.
  /// * `unix:PATH`: a bus between processes of this machine.
  /// * `sim`: the devices of the network file, simulated in this process in real time.
  /// * `virtual`: the same devices in virtual time, for tests: time passes only in Master::wait()
  ///   and Master::stop(), as fast as the machine computes, and each run is equal to the last.
  ///
  /// Empty selects the interface that the network file names.
  std::string bus;
  /// The master only listens: it sends no frame, and set() has no effect on the bus.
  bool observe = false;
  /// Time to live of the set-points, in cycles. An output whose set-point is older takes its
  /// fallback. 0 selects the time of the network file.
  std::uint32_t time_to_live = 0;
};

/// State of one node, as the master sees it.
struct NodeState {
  std::string_view nmt;   ///< NMT state: "OPERATIONAL", "pre-operational", "unknown" ...
  std::string_view boot;  ///< state of its boot: "idle", "booting", "ready", "failed", "lost"
  bool ready = false;     ///< the node has booted, is OPERATIONAL and exchanges PDOs
};

/// One event: a boot, an EMCY, a lost heartbeat, a refused command ...
struct MasterEvent {
  std::chrono::nanoseconds time{};  ///< on the clock of Master::now()
  std::uint64_t cycle = 0;          ///< number of the cycle
  std::uint8_t node = 0;            ///< node-ID; 0 means the bus
  std::string kind;  ///< stable name, the same as in event_t of LCM: "boot_failed", "emcy" ...
  std::string text;  ///< sentence for people; a failed boot has several lines
};

/// NMT commands. CiA 301, 7.2.8.2.1.
enum class NmtService : std::uint8_t {
  start = 1,                   ///< to OPERATIONAL
  stop = 2,                    ///< to STOPPED; the axes of the node are stopped before
  enter_preoperational = 128,  ///< to PRE-OPERATIONAL; the axes of the node are stopped before
  reset_node = 129,            ///< restarts the application of the device
  reset_communication = 130,   ///< restarts the communication of the device
};

/// An object of the dictionary of one node.
struct NodeObject {
  std::uint8_t node = 0;    ///< node-ID, 1..127
  std::uint16_t index = 0;  ///< index, 0x1018
  std::uint8_t sub = 0;     ///< sub-index
};

/// Number of a request. ServiceReply::request repeats it.
using RequestId = std::uint64_t;

/// The answer to one request.
struct ServiceReply {
  RequestId request = 0;          ///< the request that is answered
  bool good = false;              ///< true if the device has accepted the request
  std::uint32_t abort_code = 0;   ///< SDO abort code (CiA 301, 7.2.4.3.17); 0 means none
  std::string text;               ///< the fault in words; empty if good
  std::vector<std::byte> data{};  ///< value that was read, in little endian as on the wire
};

/// A CANopen master for one bus. Each master has a thread, the bus thread, which runs the cycle
/// with the real-time options of the network file (`realtime:`); a call waits for it only where its
/// description says so. All calls come from one thread, except request_stop().
///
/// In each cycle the devices sample their inputs at SYNC k, and wait() returns with image k. The
/// set-points that send() hands over before the outputs of the cycle are sent act at SYNC k+1.
class Master {
 public:
  /// Opens the bus, starts the bus thread and begins to boot the devices. Does not wait for the
  /// boots. On failure, returns a sentence for the user: the network file has errors, the interface
  /// does not exist, another process of this machine is the master of this bus, the machine does
  /// not grant the real-time options (`mode: enforce`) ... Unlike taktd, this call does not look
  /// for a master on another machine.
  static std::expected<Master, std::string> start(NetworkFile network, MasterOptions options = {});

  /// Calls stop().
  ~Master();
  /// Moves the master; `other` may then only be destroyed or assigned to.
  Master(Master&& other) noexcept;
  /// Stops the present master in order, then moves `other`, which may then only be destroyed or
  /// assigned to.
  Master& operator=(Master&& other) noexcept;

  /// Returns the network that the master runs.
  const NetworkFile& network() const noexcept;
  /// Returns what the machine has granted of the real-time options, in one line.
  const std::string& realtime() const noexcept;
  /// Returns the time of the bus: CLOCK_MONOTONIC, or the virtual time.
  std::chrono::nanoseconds now() const noexcept;

  /// Waits at most `longest` for the next image and takes it. Older images that wait are skipped.
  /// Returns false if no image came in time, or if the ordered stop is over. In virtual time, runs
  /// to the next image.
  bool wait(std::chrono::nanoseconds longest);
  /// Returns the number of the cycle of the newest image. It jumps by the number of missed periods.
  /// 0 before the first image.
  std::uint64_t cycle() const noexcept;
  /// Returns the time of the SYNC of the newest image, on the clock of now().
  std::chrono::nanoseconds sync_time() const noexcept;
  /// Returns the value of a signal in the newest image, in its unit. `signal` is a position in
  /// NetworkFile::signals(). An output shows the value that was sent last. 0 before the first
  /// image.
  double value(std::size_t signal) const;
  /// Returns the value of a signal in the newest image in counts: sign- or zero-extended; REAL and
  /// 64-bit unsigned values as bit patterns.
  std::int64_t raw(std::size_t signal) const;
  /// Returns true if the PDO of this signal did not arrive when it was expected.
  bool stale(std::size_t signal) const;

  /// Sets an output in its unit, rounded to whole counts; send() hands it over. Returns false and
  /// changes nothing if `signal` is no output, or if the value is not finite or does not fit into
  /// its bits. Limits of the network file are checked by the bus thread, which reports
  /// `limit_exceeded`.
  bool set(std::size_t signal, double value);
  /// Sets an output in counts. Returns false if `signal` is no output, or if the value does not fit
  /// into its bits.
  bool set_raw(std::size_t signal, std::int64_t value);
  /// Hands all outputs that were set since the last call to the bus thread, as one set. Only the
  /// newest set counts. An RPDO is sent when each of its values was set once, or has a safe value.
  void send();

  /// Returns the state of a node; `nmt` is "unknown" if no node has this node-ID.
  NodeState node(std::uint8_t node_id) const;
  /// Returns true if all nodes that the master boots are ready.
  bool all_ready() const;
  /// Returns the next event in order. Empty if there is none. At most 1024 events wait; further
  /// ones are lost.
  std::optional<MasterEvent> take_event();

  /// Requests an SDO upload of at most 1024 bytes. Empty if too many requests wait: take the
  /// replies and ask again later. Each accepted request is answered once, see take_reply().
  std::optional<RequestId> read(NodeObject object);
  /// Requests an SDO download. `data` has 1 to 1024 bytes, in little endian as on the wire. Empty
  /// if too many requests wait or if `data` is too long.
  std::optional<RequestId> write(NodeObject object, std::span<const std::byte> data);
  /// Requests an NMT command for one node, or for all nodes if `node_id` is 0. Empty if too many
  /// requests wait.
  std::optional<RequestId> nmt(NmtService service, std::uint8_t node_id);
  /// Returns the next reply. Empty if there is none. In virtual time, replies come with wait().
  std::optional<ServiceReply> take_reply();

  /// Begins the ordered stop: the outputs take their fallbacks, the axes stop and are disabled, NMT
  /// stops the nodes, SYNC ends. wait() returns false when the stop is over. Unlike all other
  /// calls, this one may also be made by any other thread and by a signal handler.
  void request_stop() noexcept;
  /// Begins the ordered stop, if it has not begun, and waits for its end. The stop takes at most
  /// `stop_timeout` of the network file, or the time that was derived from the ramps of the drives.
  /// Returns true if every axis that was enabled was seen at standstill and then disabled. The
  /// events of the stop can be taken afterwards.
  bool stop();

 private:
  class State;
  explicit Master(std::unique_ptr<State> state) noexcept;

  std::unique_ptr<State> state_;
};

}  // namespace takt
