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

/// Who hosts a bus between processes.
enum class BusMember : std::uint8_t {
  resident,  ///< where nobody else does; takes over from a host that ends
  guest,     ///< a short-lived tool: only where nobody hosts when it comes
};

struct UnixBusOptions {
  std::string path;                    ///< of `unix:PATH`, without `unix:`
  std::optional<CobId> sync_cob_id{};  ///< own frames whose echo is news().last_sync_echo
  Time spin{};
  SentFrames* sent = nullptr;  ///< counts what was sent, for a DiagnosticSocket
  BusMember member = BusMember::resident;
};

/// A bus between the processes of one machine (`unix:PATH`) as a Port, for machines whose kernel
/// has no CAN. Frames reach all other members; stamps are the hub's. Where the hub's process ends
/// the interface is down until another process has taken over; receive() looks for it, at most
/// every 10 ms. A full socket is told as ENOBUFS.
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
  PortNews news() const noexcept;

 private:
  struct State;
  friend std::pair<UnixBusPort, UnixBusPort> make_socket_pair_bus(std::optional<CobId>, Time);
  explicit UnixBusPort(std::unique_ptr<State> state) noexcept;
  std::unique_ptr<State> state_;
};

/// A bus of two members inside one process: the master's end and the devices' end. The devices'
/// end echoes what it receives, so the master sees its SYNC on the wire.
std::pair<UnixBusPort, UnixBusPort> make_socket_pair_bus(
    std::optional<CobId> sync_cob_id = CobId::base(0x080), Time spin = {});

}  // namespace takt
