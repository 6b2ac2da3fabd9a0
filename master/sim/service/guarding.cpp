#include "master/sim/service/guarding.hpp"

namespace takt::sim {
namespace {

constexpr std::uint16_t life_guard_error = 0x8130;

}  // namespace

GuardingResponder::GuardingResponder(ObjectStore& store, EmcyProducer& emcy, NodeId node)
    : store_{store}, emcy_{emcy}, node_{node} {}

void GuardingResponder::reset() noexcept {
  toggle_ = asked_ = false;
  deadline_ = never;
}

Time GuardingResponder::life_time() const noexcept {
  return std::chrono::milliseconds{store_.number({0x100C, 0}) * store_.number({0x100D, 0})};
}

/// Answers a request. Life guarding begins with the first request.
void GuardingResponder::on_request(std::uint8_t state, Fault fault, Time now,
                                   Transmitter& out) noexcept {
  if (store_.number({0x1017, 0}) != 0) return;
  asked_ = true;
  configure(now);
  emcy_.clear(life_guard_error, node_.value());
  if (fault == Fault::mute) return;
  const unsigned bit = toggle_ ? 0x80u : 0u;
  out.send(make_frame(id(), {static_cast<std::uint8_t>(bit | state)}), now);
  if (fault != Fault::stuck_toggle) toggle_ = !toggle_;
}

void GuardingResponder::configure(Time now) noexcept {
  const Time life = life_time();
  deadline_ = asked_ && life > Time{} ? now + life : never;
}

bool GuardingResponder::on_time(Time now) noexcept {
  if (now < deadline_) return false;
  deadline_ = never;
  asked_ = false;
  emcy_.raise(life_guard_error, ErrorBit::communication, {node_.value()});
  return true;
}

}  // namespace takt::sim
