#pragma once
#include <cstddef>
#include <span>

#include "eds_parser/table/bus_plan.hpp"
#include "master/core/node_status.hpp"

namespace takt {

/// Start-up of the whole network. The network is ready when every mandatory node has booted. CiA
/// 302-2, NMT start-up (0x1F80, 0x1F89).
class NetworkStart {
 public:
  explicit NetworkStart(const BusPlan& plan) noexcept : plan_{&plan} {}

  /// Begins the start-up; the boot time counts from `now`.
  void begin(Time now) noexcept;
  /// Returns true if every mandatory node has booted.
  bool ready() const noexcept { return ready_; }
  /// Returns true once, when the network has become ready.
  bool update(std::span<const NodeStatus> nodes) noexcept;
  /// Returns true once, when the boot time is over and mandatory nodes are missing.
  bool late(Time now) noexcept;
  Time deadline() const noexcept { return ready_ ? never : late_at_; }
  /// Returns the number of mandatory nodes that are not ready.
  std::size_t missing(std::span<const NodeStatus> nodes) const noexcept;
  /// Returns true if the readiness of the network is reported by an event, because nodes are
  /// mandatory or are started together.
  bool matters() const noexcept;

  template <class Archive>
  void keep(Archive& state) noexcept {
    state(ready_, late_at_);
  }

 private:
  const BusPlan* plan_;
  bool ready_ = false;
  Time late_at_ = never;
};

}  // namespace takt
