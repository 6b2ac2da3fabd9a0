#pragma once
#include "master/sim/model/io401.hpp"

namespace takt::sim {

/// Digital and analogue terminals behind a bus coupler, from the view of an FC5101. A TPDO of type
/// 0 is sampled at SYNC and sent only if the sample has changed. If SYNC is overdue according to
/// 0x1006, the outputs go to their error state (0x6206/0x6207, 0x6443/0x6444).
class BeckhoffIo final : public Io401 {
 public:
  using Io401::Io401;

  void sync_lost(Time now) noexcept override { connection_lost(now); }
  DeviceTraits traits() const noexcept override { return {.compares_samples = true}; }
};

}  // namespace takt::sim
