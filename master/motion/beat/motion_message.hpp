#pragma once
#include <cstdint>

#include "master/motion/beat/axis_report.hpp"
#include "master/motion/beat/motion_order.hpp"
#include "master/motion/beat/stream.hpp"

namespace takt::motion {

/// The subject of a message of the front thread.
enum class MessageKind : std::uint8_t {
  heard,    ///< the sender is alive
  order,    ///< `order` waits for its first cycle
  stop,     ///< the axis and its group stop along their limits
  left,     ///< this sender may not command the axis any longer
  watch,    ///< from now on, the bus thread reads the axes although no motion was commanded
  renew,    ///< the sender has named the axis, so a jog of the axis may continue
  release,  ///< the axis ends its gear, and keeps its velocity until the next motion begins
  points,   ///< more points of the stream that the axis follows, or is about to follow
};

/// A message of the front thread about motions. Plain data.
struct MotionMessage {
  MessageKind kind = MessageKind::heard;
  std::uint8_t sender = 0;  ///< used by `heard`, `left` and `renew`
  CycleNumber cycle = 0;    ///< cycle whose image the sender has seen; for `heard` and `renew`
  std::uint8_t axis = 0;    ///< used by `stop`, `left`, `renew`, `release` and `points`
  MotionOrder order{};      ///< used by `order`
  StreamPoints points{};    ///< used by `points`

  template <class Archive>
  void keep(Archive& state) noexcept {
    state(kind, sender, cycle, axis);
    if (kind == MessageKind::order) state(order);
    if (kind == MessageKind::points) state(points);
  }
};

/// Reports to the front thread how an order of an axis has ended.
struct MotionEnd {
  std::uint8_t axis = 0;
  EndedOrder order{};
  Stop stop{};  ///< valid if the order was stopped
};

}  // namespace takt::motion
