#include "master/sim/axis/profile_position.hpp"

#include <algorithm>

namespace takt::sim {
namespace {

constexpr std::uint16_t new_set_point = 0x10;
constexpr std::uint16_t change_immediately = 0x20;
constexpr std::uint16_t relative = 0x40;

}  // namespace

double within_limits(const AxisObjects& objects, double target, bool& limited) noexcept {
  const auto low = static_cast<double>(objects.limit_min.get());
  const auto high = static_cast<double>(objects.limit_max.get());
  limited = low < high && (target < low || target > high);
  return limited ? std::clamp(target, low, high) : target;
}

void ProfilePosition::start(const Demand& demand) noexcept {
  target_ = next_ = demand.position;
  buffered_ = acknowledged_ = limited_ = false;
  arrived_ = true;
}

double ProfilePosition::new_target(std::uint16_t controlword, const Demand& demand,
                                   double actual) noexcept {
  double target = static_cast<double>(objects_.target_position.get());
  if ((controlword & relative) != 0) {
    const std::int64_t reference = objects_.positioning_option.get() & 3;
    target += reference == 2 ? actual : reference == 1 ? demand.position : next_;
  }
  return within_limits(objects_, target, limited_);
}

/// Takes a set-point at a rising edge of bit 4, and ignores it if the buffer is full.
void ProfilePosition::on_controlword(std::uint16_t before, std::uint16_t now, const Demand& demand,
                                     double actual) noexcept {
  if ((now & new_set_point) == 0) acknowledged_ = false;
  if ((~before & now & new_set_point) == 0 || buffered_) return;
  next_ = new_target(now, demand, actual);
  acknowledged_ = true;
  if (arrived_ || (now & change_immediately) != 0) {
    target_ = next_;
    arrived_ = false;
  } else {
    buffered_ = true;
  }
}

void ProfilePosition::step(Demand& demand, const Ramps& ramps, double h) noexcept {
  if (arrived_) return;
  arrived_ = approach(demand, target_, ramps, h);
  if (!arrived_ || !buffered_) return;
  target_ = next_;
  buffered_ = arrived_ = false;
}

}  // namespace takt::sim
