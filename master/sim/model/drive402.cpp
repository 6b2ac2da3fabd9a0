#include "master/sim/model/drive402.hpp"

#include <algorithm>

namespace takt::sim {

Drive402::Drive402(ObjectStore& store, EmcyProducer& emcy, Random random,
                   const MechanicsTable* mechanics)
    : Model{emcy} {
  for (std::uint8_t axis = 0; axis < 8; ++axis) {
    const auto controlword = static_cast<std::uint16_t>(0x6040 + 0x800 * axis);
    if (store.find({controlword, 0}) == nullptr) continue;
    axes_.push_back(std::make_unique<Axis402>(store, emcy, random.fork(axis), axis, mechanics));
  }
}

void Drive402::reset(Time now) noexcept {
  for (const auto& axis : axes_) axis->reset(now);
}

void Drive402::advance(Time now) noexcept {
  for (const auto& axis : axes_) axis->advance(now);
}

void Drive402::outputs(Time now) noexcept {
  for (const auto& axis : axes_) axis->outputs(now);
}

void Drive402::on_sync(Time now) noexcept {
  for (const auto& axis : axes_) axis->on_sync(now);
}

Abort Drive402::check_write(const Object& object, std::uint64_t raw) const noexcept {
  for (const auto& axis : axes_) {
    const Abort refused = axis->check_write(object, raw);
    if (refused != Abort::none) return refused;
  }
  return Abort::none;
}

void Drive402::connection_lost(Time) noexcept {
  for (const auto& axis : axes_) axis->connection_lost();
}

void Drive402::fail(std::uint16_t code, Time) noexcept {
  for (const auto& axis : axes_) axis->fail(code);
}

Time Drive402::next_change() const noexcept {
  Time next = never;
  for (const auto& axis : axes_) next = std::min(next, axis->next_change());
  return next;
}

}  // namespace takt::sim
