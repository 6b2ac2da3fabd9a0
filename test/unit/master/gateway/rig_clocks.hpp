#pragma once
#include "master/lcm/clocks.hpp"
#include "test/virtual/rig.hpp"

namespace takt::test {

/// The clocks of a rig. The virtual time is also the wall clock.
class RigClocks final : public Clocks {
 public:
  explicit RigClocks(const Rig& rig) : rig_{rig} {}
  Time now() const noexcept override { return rig_.world->now(); }
  Time wall_offset() const noexcept override { return {}; }

 private:
  const Rig& rig_;
};

}  // namespace takt::test
