#pragma once
#include <cstdint>

#include "eds_parser/values/ids.hpp"
#include "eds_parser/values/time.hpp"
#include "master/sim/dictionary/object_store.hpp"
#include "master/sim/service/emcy_producer.hpp"
#include "master/sim/service/transmitter.hpp"

namespace takt::sim {

/// The device side of guarding. It answers the remote frames of the master. For life guarding, it
/// detects that no request has come for 0x100C x 0x100D ms. CiA 301, 7.2.8.3.2.1.
class GuardingResponder {
 public:
  enum class Fault : std::uint8_t { none, mute, stuck_toggle };

  GuardingResponder(ObjectStore& store, EmcyProducer& emcy, NodeId node);
  /// Sets the node-ID that LSS has given to the device.
  void set_node(NodeId node) noexcept { node_ = node; }

  CobId id() const noexcept { return CobId::base(0x700u + node_.value()); }
  /// Call this when communication was reset. The next answer then has toggle bit 0.
  void reset() noexcept;
  /// Handles a remote frame of the master. A device that produces heartbeats does not answer.
  void on_request(std::uint8_t state, Fault fault, Time now, Transmitter& out) noexcept;
  /// Returns true if the life time has just expired without a request of the master.
  bool on_time(Time now) noexcept;
  Time deadline() const noexcept { return deadline_; }
  /// Call this when 0x100C or 0x100D was written.
  void configure(Time now) noexcept;

 private:
  Time life_time() const noexcept;

  ObjectStore& store_;
  EmcyProducer& emcy_;
  NodeId node_;
  bool toggle_ = false;
  bool asked_ = false;
  Time deadline_ = never;
};

}  // namespace takt::sim
