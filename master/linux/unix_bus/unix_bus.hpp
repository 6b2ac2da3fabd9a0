#pragma once
#include <cstdint>
#include <expected>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "master/linux/bus_error.hpp"
#include "master/linux/clock.hpp"
#include "master/linux/sent_frames.hpp"
#include "master/rt/port.hpp"

namespace takt {

/// The role of a member in hosting a bus between processes.
enum class BusMember : std::uint8_t {
  resident,  ///< hosts if nobody else does, and takes over from a host that ends
  guest,     ///< a short-lived tool; hosts only if nobody hosts when it joins
};

struct UnixBusOptions {
  std::string path;  ///< path of `unix:PATH`, without `unix:`
  /// COB-ID of the SYNC that this port sends. condition().last_sync_echo is the time of its newest
  /// echo.
  std::optional<CobId> sync_cob_id{};
  Time spin{};
  SentFrames* sent = nullptr;  ///< counts the sent frames for a DiagnosticSocket
  BusMember member = BusMember::resident;
};

/// A bus between the processes of one machine (`unix:PATH`) as a Port, for machines whose kernel
/// has no CAN. Frames reach all other members; the hub sets the time stamps. If the process of the
/// hub ends, the interface is down until another process has taken over; receive() looks for the
/// new hub at most every 10 ms. The port reports a full socket as ENOBUFS.
class UnixBusPort {
 public:
  static std::expected<UnixBusPort, BusError> open(const UnixBusOptions& options);
  UnixBusPort(UnixBusPort&&) noexcept;
  UnixBusPort& operator=(UnixBusPort&&) noexcept;
  ~UnixBusPort();

  Time now() const noexcept { return monotonic_now(); }
  void sleep_until(Time until) noexcept { takt::sleep_until(until); }
  void sleep_precisely_until(Time until) noexcept;
  bool wait_frame(Time until) noexcept;
  std::size_t receive(std::span<StampedFrame> in) noexcept;
  SendResult send(std::span<const Frame> out) noexcept;
  PortCondition condition() const noexcept;

 private:
  struct State;
  friend std::pair<UnixBusPort, UnixBusPort> make_socket_pair_bus(std::optional<CobId>, Time);
  explicit UnixBusPort(std::unique_ptr<State> state) noexcept;
  std::unique_ptr<State> state_;
};

/// Makes a bus of two members inside one process: the master's end and the devices' end. The
/// devices' end echoes what it receives, so the master sees its own SYNC on the wire.
std::pair<UnixBusPort, UnixBusPort> make_socket_pair_bus(
    std::optional<CobId> sync_cob_id = CobId::base(0x080), Time spin = {});

}  // namespace takt
