#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

#include "eds_parser/table/bus_plan.hpp"
#include "master/core/node_status.hpp"

namespace takt {

/// Start-up of the whole network: it is ready when every mandatory node has booted. CiA 302-2,
/// NMT start-up (0x1F80, 0x1F89).
class NetworkStart {
 public:
  explicit NetworkStart(const BusPlan& plan) noexcept : plan_{&plan} {}

  void begin(Time now) noexcept;
  bool ready() const noexcept { return ready_; }
  /// True: it is ready just now.
  bool update(std::span<const NodeStatus> nodes) noexcept;
  /// True, once: the boot time is over and mandatory nodes are missing.
  bool late(Time now) noexcept;
  Time deadline() const noexcept { return ready_ ? never : late_at_; }
  std::size_t missing(std::span<const NodeStatus> nodes) const noexcept;
  /// Somebody waits for it, so it is worth telling.
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
