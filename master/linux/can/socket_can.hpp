#pragma once
#include <expected>
#include <linux/can.h>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "eds_parser/table/bus_plan.hpp"
#include "master/linux/bus_error.hpp"
#include "master/linux/clock.hpp"
#include "master/linux/sent_frames.hpp"
#include "master/rt/port.hpp"

namespace takt {

struct SocketCanOptions {
  std::string interface;
  std::vector<can_filter> filters;  ///< at most max_kernel_filters; see filters_for
  /// The kernel echoes frames of this port with this identifier when they were on the wire;
  /// condition().last_sync_echo is the newest echo. The kernel echoes only identifiers that pass
  /// `filters`.
  std::optional<CobId> sync_cob_id{};
  Time spin{};                 ///< spin time of sleep_precisely_until
  SentFrames* sent = nullptr;  ///< counts the sent frames for a DiagnosticSocket
};

/// A CAN interface of the kernel as a Port. Each sleep, wait, receive and send makes one system
/// call. There are three exceptions. If the kernel has taken only a part of a batch, the port makes
/// one more call to send the rest. If a full batch contained messages that were only for the port
/// itself, the port makes another call to refill it. While the interface is missing, receive()
/// looks for it by its name, at most every 50 ms.
class SocketCanPort {
 public:
  static std::expected<SocketCanPort, BusError> open(const SocketCanOptions& options);
  /// Opens the port for the bus thread, with filters and SYNC from the plan.
  static std::expected<SocketCanPort, BusError> open(const std::string& interface,
                                                     const BusPlan& plan, Time spin,
                                                     SentFrames* sent = nullptr);
  SocketCanPort(SocketCanPort&&) noexcept;
  SocketCanPort& operator=(SocketCanPort&&) noexcept;
  ~SocketCanPort();

  Time now() const noexcept { return monotonic_now(); }
  void sleep_until(Time until) noexcept { takt::sleep_until(until); }
  void sleep_precisely_until(Time until) noexcept;
  bool wait_frame(Time until) noexcept;
  std::size_t receive(std::span<StampedFrame> in) noexcept;
  SendResult send(std::span<const Frame> out) noexcept;
  PortCondition condition() const noexcept;

 private:
  struct State;
  explicit SocketCanPort(std::unique_ptr<State> state) noexcept;
  std::unique_ptr<State> state_;
};

}  // namespace takt
