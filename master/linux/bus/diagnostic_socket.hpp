#pragma once
#include <cstdint>
#include <expected>
#include <functional>
#include <memory>
#include <string_view>

#include "master/core/event.hpp"
#include "master/linux/bus/intruder_watch.hpp"
#include "master/linux/bus_error.hpp"
#include "master/linux/sent_frames.hpp"

namespace takt {

/// Traffic on the bus since the socket was opened.
struct HeardTraffic {
  std::uint64_t frames = 0;
  /// Number of bits with the stuff bits of average data; load = bits / (t * bit rate).
  std::uint64_t bits = 0;
  /// Number of frames that this socket lost because it was read too slowly.
  std::uint64_t lost = 0;
  std::uint64_t error_frames = 0;  ///< error frames of all classes, including single bus errors
};

/// A second socket for the front side. It receives every frame of the bus without a filter,
/// including those of the bus thread, and feeds the intruder watch and recordings. The socket may
/// be used by one thread, which must not be the bus thread.
class DiagnosticSocket {
 public:
  using OnFrame = std::function<void(const StampedFrame&)>;

  /// `bus` has the form that open_bus() accepts. The port of the bus thread counts into `sent`,
  /// which must outlive this object.
  static std::expected<DiagnosticSocket, BusError> open(std::string_view bus, const BusPlan& plan,
                                                        const SentFrames& sent);
  DiagnosticSocket(DiagnosticSocket&&) noexcept;
  DiagnosticSocket& operator=(DiagnosticSocket&&) noexcept;
  ~DiagnosticSocket();

  /// Returns the descriptor for poll(2), or -1 while the interface is missing. The descriptor
  /// changes when the interface comes back.
  int fd() const noexcept;
  /// Takes the waiting frames (at most 4096) without blocking. If the interface is gone, looks for
  /// it once per second.
  void poll(const OnFrame& on_frame = {});
  bool take(Event& event);
  HeardTraffic traffic() const noexcept;

 private:
  struct State;
  explicit DiagnosticSocket(std::unique_ptr<State> state) noexcept;
  std::unique_ptr<State> state_;
};

}  // namespace takt
