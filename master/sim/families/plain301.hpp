#pragma once
#include "master/sim/model.hpp"

namespace takt::sim {

/// How a device may read 0x1800:05.
enum class EventTimerReading : std::uint8_t {
  restarts,    ///< as CiA 301: every transmission restarts it
  own_raster,  ///< only its own expiry restarts it
};

/// A device of an older CiA 301: PDO parameters 1, 2, 3 and 5 only. What is written to 0x2001 comes
/// back in 0x2101, by sub-index; 0x2102 counts tenths of a second.
class Plain301 final : public Model {
 public:
  Plain301(ObjectStore& store, EmcyProducer& emcy, EventTimerReading reading);

  void reset(Time now) noexcept override;
  void advance(Time now) noexcept override;
  void outputs(Time now) noexcept override;
  void fail(std::uint16_t code, Time now) noexcept override;
  Time next_change() const noexcept override { return counter_ == nullptr ? never : next_count_; }
  DeviceTraits traits() const noexcept override;

 private:
  ObjectStore& store_;
  EmcyProducer& emcy_;
  EventTimerReading reading_;
  Object* counter_;
  Time next_count_ = never;
};

}  // namespace takt::sim
