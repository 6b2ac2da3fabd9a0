#include "master/sim/model/encoder406.hpp"

namespace takt::sim {
namespace {

constexpr std::int64_t turn_back_ms = 10'000;
constexpr std::int64_t default_units = 4096;

}  // namespace

Encoder406::Encoder406(ObjectStore& store, EmcyProducer& emcy, Random random)
    : Model{emcy},
      position_{store, {0x6004, 0}},
      preset_{store, {0x6003, 0}},
      units_{store, {0x6001, 0}},
      range_{store, {0x6002, 0}},
      speed_{store, {0x6030, 1}} {
  const std::int64_t units = units_.get() > 0 ? units_.get() : default_units;
  steps_a_second_ = units * (500 + random.below(1500)) / 1000;  // 0.5 to 2 turns per second
}

void Encoder406::reset(Time now) noexcept {
  time_ = now;
  last_preset_ = preset_.get();
  publish();
}

void Encoder406::advance(Time now) noexcept {
  if (now <= time_) return;
  time_ = now;
  publish();
}

/// Returns the position of the shaft in steps. The shaft turns ten seconds in each direction.
std::int64_t Encoder406::shaft(Time now) const noexcept {
  const std::int64_t us = std::chrono::duration_cast<std::chrono::microseconds>(now).count();
  const std::int64_t period = 2 * turn_back_ms * 1000;
  const std::int64_t phase = us % period;
  const std::int64_t way = phase < period / 2 ? phase : period - phase;
  return way * steps_a_second_ / 1'000'000;
}

void Encoder406::publish() noexcept {
  std::int64_t position = shaft(time_) + offset_;
  const std::int64_t range = range_.get();
  if (range > 0) position = ((position % range) + range) % range;
  position_.set(position);
  const bool forth =
      time_ % std::chrono::milliseconds{2 * turn_back_ms} < std::chrono::milliseconds{turn_back_ms};
  speed_.set(forth ? steps_a_second_ : -steps_a_second_);
}

void Encoder406::outputs(Time) noexcept {
  if (!preset_.exists() || preset_.get() == last_preset_) return;
  last_preset_ = preset_.get();
  offset_ = last_preset_ - shaft(time_);
  publish();
}

}  // namespace takt::sim
