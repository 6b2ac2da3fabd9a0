#include "master/sim/service/sync_consumer.hpp"

#include <algorithm>

#include "master/sim/dictionary/cob_rules.hpp"

namespace takt::sim {
namespace {

constexpr std::uint16_t sync_missing = 0x8100;
constexpr std::uint16_t sync_length = 0x8240;

/// SYNC is overdue after 1.5 periods, but not earlier than this time after the period: a master
/// without real-time scheduling may send SYNC that late.
constexpr Time least_timeout = std::chrono::milliseconds{20};

std::uint64_t value_of(const Object* object) noexcept {
  return object == nullptr ? 0 : object->value;
}

}  // namespace

SyncConsumer::SyncConsumer(ObjectStore& store, EmcyProducer& emcy)
    : emcy_{emcy},
      cob_{store.find({0x1005, 0})},
      period_{store.find({0x1006, 0})},
      window_{store.find({0x1007, 0})},
      overflow_{store.find({0x1019, 0})} {}

void SyncConsumer::reset() noexcept { deadline_ = window_end_ = never; }

CobId SyncConsumer::id() const noexcept {
  return cob_ == nullptr ? CobId::base(0x080) : cob_id(cob_->value);
}

std::uint8_t SyncConsumer::on_sync(const Frame& frame, Time now) noexcept {
  const std::uint64_t period = value_of(period_);
  const Time expected = std::chrono::microseconds{period};
  deadline_ = period == 0 ? never : now + expected + std::max(expected / 2, least_timeout);
  const std::uint64_t window = value_of(window_);
  window_end_ = window == 0 ? never : now + std::chrono::microseconds{window};
  emcy_.clear(sync_missing);
  const bool counted = value_of(overflow_) != 0;
  if (frame.length != (counted ? 1 : 0)) {
    emcy_.raise(sync_length, ErrorBit::communication);
    return 0;
  }
  emcy_.clear(sync_length);
  return counted ? frame.data[0] : 0;
}

bool SyncConsumer::on_time(Time now) noexcept {
  if (now < deadline_) return false;
  deadline_ = never;
  emcy_.raise(sync_missing, ErrorBit::communication);
  return true;
}

Abort SyncConsumer::check_write(const Object& object, std::uint64_t raw) const noexcept {
  if (&object == cob_) {
    const bool produces = (raw & cob_bit30) != 0;
    const bool bad = has_stray_bits(raw) || is_restricted(cob_id(raw));
    return (produces && !may_produce_) || bad ? Abort::value : Abort::none;
  }
  if (&object == overflow_) {
    if (raw == 1 || raw > 240) return Abort::value;
    if (value_of(period_) != 0 && raw != object.value) return Abort::device_state;
  }
  return Abort::none;
}

}  // namespace takt::sim
