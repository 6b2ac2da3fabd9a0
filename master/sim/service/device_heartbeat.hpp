#pragma once
#include <cstdint>
#include <vector>

#include "eds_parser/values/ids.hpp"
#include "eds_parser/values/time.hpp"
#include "master/sim/dictionary/abort.hpp"
#include "master/sim/dictionary/object_store.hpp"
#include "master/sim/service/emcy_producer.hpp"
#include "master/sim/service/transmitter.hpp"

namespace takt::sim {

/// Sends the NMT state every 0x1017 ms. CiA 301, 7.2.8.3.2.2.
class HeartbeatProducer {
 public:
  HeartbeatProducer(ObjectStore& store, NodeId node)
      : period_{store.find({0x1017, 0})}, node_{node} {}
  /// Sets the node-ID that LSS has given to the device.
  void set_node(NodeId node) noexcept { node_ = node; }

  /// Starts the heartbeat. The boot-up message counts as the first one.
  void start(Time now) noexcept;
  void stop() noexcept { next_ = never; }
  void on_time(Time now, std::uint8_t state, bool mute, Transmitter& out) noexcept;
  Time deadline() const noexcept { return next_; }

 private:
  Object* period_;
  NodeId node_;
  Time next_ = never;
};

/// Monitors the heartbeats of the nodes in 0x1016. Monitoring of a node begins with its first
/// heartbeat.
class HeartbeatConsumer {
 public:
  HeartbeatConsumer(ObjectStore& store, EmcyProducer& emcy);

  /// Call this after a reset and after a write to 0x1016.
  void configure() noexcept;
  void forget() noexcept;
  void on_heartbeat(std::uint8_t node, std::uint8_t state, Time now) noexcept;
  /// Returns true if the heartbeat of a node has just timed out.
  bool on_time(Time now) noexcept;
  Time deadline() const noexcept { return deadline_; }
  Abort check_write(const Object& object, std::uint64_t raw) const noexcept;

  struct Watch {
    const Object* entry = nullptr;
    std::uint8_t node = 0;  ///< node-ID; 0 means that the entry is not used
    Time timeout{};
    Time deadline = never;  ///< `never` until the first heartbeat
  };
  const std::vector<Watch>& watches() const noexcept { return watches_; }

 private:
  void update_deadline() noexcept;

  EmcyProducer& emcy_;
  std::vector<Watch> watches_;
  Time deadline_ = never;
};

}  // namespace takt::sim
