#include "master/sim/family/plain301.hpp"

#include "master/sim/family/echo.hpp"

namespace takt::sim {
namespace {

constexpr std::uint16_t values_in = 0x2001;
constexpr std::uint16_t values_out = 0x2101;
constexpr ObjectKey counter_key{0x2102, 0};
constexpr Time count_period = std::chrono::milliseconds{100};

}  // namespace

Plain301::Plain301(ObjectStore& store, EmcyProducer& emcy, EventTimerReading reading)
    : Model{emcy}, store_{store}, reading_{reading}, counter_{store.find(counter_key)} {}

DeviceTraits Plain301::traits() const noexcept {
  DeviceTraits traits;
  if (reading_ == EventTimerReading::own_raster) traits.timer = DeviceTraits::Timer::own_raster;
  return traits;
}

void Plain301::reset(Time now) noexcept { next_count_ = now + count_period; }

void Plain301::advance(Time now) noexcept {
  while (counter_ != nullptr && now >= next_count_) {
    counter_->set(counter_->value + 1);
    next_count_ += count_period;
  }
}

void Plain301::outputs(Time) noexcept { echo(store_, values_in, values_out); }

}  // namespace takt::sim
