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
  /// Own frames of this identifier are echoed by the kernel when they were on the wire; the newest
  /// echo is news().last_sync_echo. Only identifiers that pass `filters` are echoed.
  std::optional<CobId> sync_cob_id{};
  Time spin{};                 ///< of sleep_precisely_until
  SentFrames* sent = nullptr;  ///< counts what was sent, for a DiagnosticSocket
};

/// A CAN interface of the kernel as a Port. One system call for each sleep, wait, receive and send;
/// more only in trouble: the rest of a batch that was cut short is tried once, a full batch in
/// which something was for the port alone is filled up, and an interface that is gone is looked for
/// at most every 50 ms, by name, from within receive().
class SocketCanPort {
 public:
  static std::expected<SocketCanPort, BusError> open(const SocketCanOptions& options);
  /// As the bus thread needs it: filters and SYNC from the plan.
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
  PortNews news() const noexcept;

 private:
  struct State;
  explicit SocketCanPort(std::unique_ptr<State> state) noexcept;
  std::unique_ptr<State> state_;
};

}  // namespace takt
