#pragma once
#include <cstdint>
#include <expected>
#include <functional>
#include <memory>
#include <string_view>

#include "master/core/event.hpp"
#include "master/linux/bus_error.hpp"
#include "master/linux/intruder_watch.hpp"
#include "master/linux/sent_frames.hpp"

namespace takt {

/// What has gone over the bus since the socket was opened.
struct HeardTraffic {
  std::uint64_t frames = 0;
  std::uint64_t bits = 0;  ///< with the stuff bits of average data; load = bits / (t * bit rate)
  std::uint64_t lost = 0;  ///< frames that this socket was too slow for
  std::uint64_t error_frames = 0;  ///< of all classes, single bus errors included
};

/// The front side's ear: hears every frame of the bus, unfiltered, the bus thread's own included.
/// Feeds the intruder watch and whoever wants to record. One thread, not the bus thread.
class DiagnosticSocket {
 public:
  using OnFrame = std::function<void(const StampedFrame&)>;

  /// `bus` as in open_bus; `sent` is what the port of the bus thread counts into, and outlives
  /// this.
  static std::expected<DiagnosticSocket, BusError> open(std::string_view bus, const BusPlan& plan,
                                                        const SentFrames& sent);
  DiagnosticSocket(DiagnosticSocket&&) noexcept;
  DiagnosticSocket& operator=(DiagnosticSocket&&) noexcept;
  ~DiagnosticSocket();

  /// For poll(2); -1 while the interface is gone. Changes when it comes back.
  int fd() const noexcept;
  /// Takes what is waiting (at most 4096 frames), without waiting. An interface that is gone is
  /// looked for once a second.
  void poll(const OnFrame& on_frame = {});
  bool take(Event& event);
  HeardTraffic traffic() const noexcept;

 private:
  struct State;
  explicit DiagnosticSocket(std::unique_ptr<State> state) noexcept;
  std::unique_ptr<State> state_;
};

}  // namespace takt
