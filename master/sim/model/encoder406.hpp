#pragma once
#include "master/sim/axis/axis_objects.hpp"
#include "master/sim/model/model.hpp"

namespace takt::sim {

/// An encoder on a shaft that turns back and forth. The speed depends on the seed. Position 0x6004,
/// preset 0x6003, speed 0x6030:01. CiA 406.
class Encoder406 final : public Model {
 public:
  Encoder406(ObjectStore& store, EmcyProducer& emcy, Random random);

  void reset(Time now) noexcept override;
  void advance(Time now) noexcept override;
  /// A written preset becomes the present position.
  void outputs(Time now) noexcept override;
  Time next_change() const noexcept override { return time_ + Time{1}; }

 private:
  std::int64_t shaft(Time now) const noexcept;
  void publish() noexcept;

  Slot position_;
  Slot preset_;
  Slot units_;
  Slot range_;
  Slot speed_;
  std::int64_t steps_a_second_ = 0;
  std::int64_t offset_ = 0;
  std::int64_t last_preset_ = 0;
  Time time_{};
};

}  // namespace takt::sim
