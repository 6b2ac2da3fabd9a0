#include "master/sim/service/sync_producer.hpp"

#include "master/sim/dictionary/cob_rules.hpp"

namespace takt::sim {

SyncProducer::SyncProducer(ObjectStore& store)
    : cob_{store.find({0x1005, 0})},
      period_{store.find({0x1006, 0})},
      overflow_{store.find({0x1019, 0})} {}

Time SyncProducer::period() const noexcept {
  if (cob_ == nullptr || period_ == nullptr || (cob_->value & cob_bit30) == 0) return Time{};
  return std::chrono::microseconds{period_->value};
}

void SyncProducer::start(Time now) noexcept {
  counter_ = 0;
  next_ = period() == Time{} ? never : now + period();
}

std::optional<Frame> SyncProducer::on_time(Time now, std::optional<CobId> id) noexcept {
  if (now < next_) return {};
  next_ += period();
  const CobId sync = id.value_or(cob_id(cob_->value));
  const std::uint64_t overflow = overflow_ == nullptr ? 0 : overflow_->value;
  if (overflow < 2) return Frame{.id = sync};
  counter_ = counter_ >= overflow ? std::uint8_t{1} : static_cast<std::uint8_t>(counter_ + 1);
  return make_frame(sync, {counter_});
}

}  // namespace takt::sim
