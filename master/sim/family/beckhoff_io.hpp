#pragma once
#include "master/sim/model/io401.hpp"

namespace takt::sim {

/// Digital and analogue terminals behind a bus coupler, as an FC5101 sees them. A TPDO of type 0 is
/// sampled at SYNC and sent only if the sample has changed. If SYNC is overdue according to 0x1006,
/// the outputs go to their error state (0x6206/0x6207, 0x6443/0x6444).
class BeckhoffIo final : public Model {
 public:
  BeckhoffIo(ObjectStore& store, EmcyProducer& emcy, Random random, bool loopback)
      : io_{store, emcy, random, loopback} {}

  void reset(Time now) noexcept override { io_.reset(now); }
  void advance(Time now) noexcept override { io_.advance(now); }
  void outputs(Time now) noexcept override { io_.outputs(now); }
  void sync_lost(Time now) noexcept override { io_.connection_lost(now); }
  void connection_lost(Time now) noexcept override { io_.connection_lost(now); }
  void fail(std::uint16_t code, Time now) noexcept override { io_.fail(code, now); }
  Time next_change() const noexcept override { return io_.next_change(); }
  DeviceTraits traits() const noexcept override { return {.compares_samples = true}; }

 private:
  Io401 io_;
};

}  // namespace takt::sim
