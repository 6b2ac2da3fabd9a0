#pragma once
#include <cstdint>

#include "eds_parser/table/time.hpp"
#include "master/wire/frame.hpp"

namespace takt::sim {

/// What became of a frame on the wire.
enum class WireResult : std::uint8_t {
  sent,
  destroyed,       ///< an error frame followed; the sender repeats it
  unacknowledged,  ///< nobody else on the bus; the sender repeats it
  lost,            ///< sent, but by a fault nobody took it
};

/// Position of a sender or receiver on the virtual bus.
using BusNodeIndex = std::uint16_t;

/// A frame as it was on the wire. `end` is the last bit of EOF; the interframe space follows.
struct WireFrame {
  Frame frame{};
  Time start{};
  Time end{};
  BusNodeIndex sender = 0;
  WireResult result = WireResult::sent;
  std::uint16_t bits = 0;  ///< without interframe space; with error frame where destroyed
};

/// Hears everything that is on the wire, errors included. Must not call back into the world.
class BusObserver {
 public:
  virtual ~BusObserver() = default;
  virtual void on_wire(const WireFrame& frame) noexcept = 0;
};

}  // namespace takt::sim
