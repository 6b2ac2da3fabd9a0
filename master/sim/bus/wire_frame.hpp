#pragma once
#include <cstdint>

#include "eds_parser/values/time.hpp"
#include "master/wire/frame.hpp"

namespace takt::sim {

/// Result of the transmission of a frame.
enum class WireResult : std::uint8_t {
  sent,
  destroyed,       ///< an error frame followed; the sender repeats the frame
  unacknowledged,  ///< no other node is on the bus; the sender repeats the frame
  lost,            ///< sent, but because of a fault no node received it
};

/// Position of a sender or receiver on the virtual bus.
using BusNodeIndex = std::uint16_t;

/// A frame as it was on the wire. `end` is the end of the last bit of EOF; the interframe space
/// follows.
struct WireFrame {
  Frame frame{};
  Time start{};
  Time end{};
  BusNodeIndex sender = 0;
  WireResult result = WireResult::sent;
  std::uint16_t bits = 0;  ///< without interframe space, with the error frame if destroyed
};

/// Receives everything that is on the wire, including errors. An observer must not call back into
/// the world.
class BusObserver {
 public:
  virtual ~BusObserver() = default;
  virtual void on_wire(const WireFrame& frame) noexcept = 0;
};

}  // namespace takt::sim
