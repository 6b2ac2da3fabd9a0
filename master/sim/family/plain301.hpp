#pragma once
#include "master/sim/model/model.hpp"

namespace takt::sim {

/// Interpretations of the event timer 0x1800:05.
enum class EventTimerReading : std::uint8_t {
  restarts,    ///< every transmission restarts the timer, as in CiA 301
  own_raster,  ///< only expiry restarts the timer
};

/// A device for an older CiA 301, with the PDO parameters 1, 2, 3 and 5 only. Values written to
/// 0x2001 come back in the same sub-index of 0x2101; 0x2102 counts tenths of a second.
class Plain301 final : public Model {
 public:
  Plain301(ObjectStore& store, EmcyProducer& emcy, EventTimerReading reading);

  void reset(Time now) noexcept override;
  void advance(Time now) noexcept override;
  void outputs(Time now) noexcept override;
  Time next_change() const noexcept override { return counter_ == nullptr ? never : next_count_; }
  DeviceTraits traits() const noexcept override;

 private:
  ObjectStore& store_;
  EventTimerReading reading_;
  Object* counter_;
  Time next_count_ = never;
};

}  // namespace takt::sim
