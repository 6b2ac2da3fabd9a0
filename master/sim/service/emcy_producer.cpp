#include "master/sim/service/emcy_producer.hpp"

#include <algorithm>

#include "master/sim/dictionary/cob_rules.hpp"

namespace takt::sim {
namespace {

constexpr std::uint16_t history = 0x1003;

}  // namespace

EmcyProducer::EmcyProducer(ObjectStore& store, NodeId node)
    : store_{store},
      node_{node},
      register_{store.find({0x1001, 0})},
      cob_{store.find({0x1014, 0})},
      inhibit_{store.find({0x1015, 0})} {}

void EmcyProducer::reset() noexcept {
  active_count_ = waiting_ = 0;
  allowed_from_ = Time{};
  if (register_ != nullptr) register_->set(0);
}

bool EmcyProducer::is_active(std::uint16_t code, std::uint8_t source) const noexcept {
  const auto end = active_.begin() + static_cast<std::ptrdiff_t>(active_count_);
  return std::any_of(active_.begin(), end, [code, source](Error error) {
    return error.code == code && error.source == source;
  });
}

std::uint8_t EmcyProducer::error_register() const noexcept {
  std::uint8_t bits = 0;
  for (std::size_t i = 0; i < active_count_; ++i) bits |= active_[i].bits;
  return bits;
}

void EmcyProducer::raise(std::uint16_t code, ErrorBit bit, Detail detail) noexcept {
  if (active_count_ == active_.size() || is_active(code, detail[0])) return;
  const auto bits = static_cast<std::uint8_t>(static_cast<unsigned>(bit) | 1u);
  active_[active_count_++] = {code, detail[0], bits};
  if (register_ != nullptr) register_->set(error_register());
  push(code, detail);
}

void EmcyProducer::clear_active(std::uint16_t code, std::uint8_t source) noexcept {
  const auto end = active_.begin() + static_cast<std::ptrdiff_t>(active_count_);
  const auto kept = std::remove_if(active_.begin(), end, [code, source](Error error) {
    return error.code == code && error.source == source;
  });
  if (kept == end) return;
  active_count_ = static_cast<std::size_t>(kept - active_.begin());
  if (register_ != nullptr) register_->set(error_register());
  push(0, {});
}

void EmcyProducer::announce(std::uint16_t code, Detail detail) noexcept { push(code, detail); }

void EmcyProducer::push(std::uint16_t code, Detail detail) noexcept {
  if (code != 0) remember(code);
  if (waiting_ < queue_.size()) queue_[waiting_++] = {code, error_register(), detail};
}

/// Enters the code in sub-index 1 of the history and drops the oldest entry if the history is full.
void EmcyProducer::remember(std::uint16_t code) noexcept {
  Object* count = store_.find({history, 0});
  if (count == nullptr) return;
  std::uint8_t places = 0;
  while (places < 254 && store_.find({history, static_cast<std::uint8_t>(places + 1)}) != nullptr) {
    ++places;
  }
  for (std::uint8_t sub = places; sub > 1; --sub) {
    const Object* older = store_.find({history, static_cast<std::uint8_t>(sub - 1)});
    store_.find({history, sub})->set(older->value);
  }
  if (places != 0) store_.find({history, 1})->set(code);
  count->set(std::min<std::uint64_t>(count->value + 1, places));
}

void EmcyProducer::send_waiting(Time now, Transmitter& out) noexcept {
  const bool silent = cob_ != nullptr && (cob_->value & cob_invalid) != 0;
  const Time gap = inhibit_ == nullptr
                       ? Time{}
                       : std::chrono::microseconds{100} * static_cast<long>(inhibit_->value);
  const std::size_t count = gap == Time{} || silent ? waiting_ : 1;
  for (std::size_t i = 0; i < count && !silent; ++i) out.send(encode(queue_[i]), now);
  std::copy(queue_.begin() + static_cast<std::ptrdiff_t>(count),
            queue_.begin() + static_cast<std::ptrdiff_t>(waiting_), queue_.begin());
  waiting_ -= count;
  allowed_from_ = now + gap;
}

Frame EmcyProducer::encode(const Message& message) const noexcept {
  const CobId id = cob_ != nullptr ? cob_id(cob_->value) : CobId::base(0x080u + node_.value());
  const Detail& d = message.detail;
  return make_frame(id, {static_cast<std::uint8_t>(message.code & 0xFF),
                         static_cast<std::uint8_t>(message.code >> 8), message.error_register, d[0],
                         d[1], d[2], d[3], d[4]});
}

Abort EmcyProducer::check_read(ObjectKey key) const noexcept {
  if (key.index != history || key.sub == 0) return Abort::none;
  return static_cast<std::int64_t>(key.sub) > store_.number({history, 0}) ? Abort::no_data
                                                                          : Abort::none;
}

Abort EmcyProducer::check_write(const Object& object, std::uint64_t raw) const noexcept {
  if (object.key == ObjectKey{history, 0}) return raw == 0 ? Abort::none : Abort::value;
  if (object.key == ObjectKey{0x1014, 0}) {
    // If the limits of the object forbid bit 31, a client can't disable EMCY before it changes the
    // COB-ID.
    const bool has_off_bit = !object.high || *object.high >= std::int64_t{cob_invalid};
    const bool stays_valid = ((object.value | raw) & cob_invalid) == 0;
    if (has_off_bit && stays_valid && raw != object.value) return Abort::value;
    if (has_stray_bits(raw)) return Abort::value;
    if ((raw & cob_invalid) == 0 && is_restricted(cob_id(raw))) return Abort::value;
  }
  return Abort::none;
}

void EmcyProducer::written(const Object& object) noexcept {
  if (object.key != ObjectKey{history, 0}) return;
  for (Object& entry : store_.range(history, history)) entry.set(0);
}

}  // namespace takt::sim
