#include "master/sim/family/lenze8400.hpp"

#include "eds_parser/table/pdo_number.hpp"
#include "master/sim/dictionary/cob_rules.hpp"
#include "master/sim/family/echo.hpp"

namespace takt::sim {
namespace {

constexpr std::uint16_t words_in = 0x5C9D;
constexpr std::uint16_t words_out = 0x5C9B;
constexpr ObjectKey code_sync_in{0x5E90, 0};   // C00367: index 0x5FFF - number
constexpr ObjectKey code_sync_out{0x5E8F, 0};  // C00368

constexpr std::uint64_t bit_enable = 0x0001;
constexpr std::uint64_t bit_reset_fault = 0x0080;
constexpr std::uint64_t status_ready = 0x0001;
constexpr std::uint64_t status_enabled = 0x0002;
constexpr std::uint64_t status_fault = 0x0008;
constexpr std::int64_t counts_a_second = 16384;  // from standstill to nominal speed in one second

constexpr Firmware newest{{16, 0, 0}};
constexpr Firmware obeys_itself{{16, 0, 0}};

bool is_cob_id(ObjectKey key) noexcept {
  if (key.index == 0x1201) return key.sub == 1 || key.sub == 2;
  return is_pdo_cob_id(key);
}

}  // namespace

Lenze8400::Lenze8400(const DeviceTable& table, ObjectStore& store, EmcyProducer& emcy)
    : Model{emcy},
      store_{store},
      firmware_{Firmware::parse(table.firmware).value_or(newest)},
      control_{store.find({words_in, 1})},
      set_point_{store.find({words_in, 2})},
      status_{store.find({words_out, 1})},
      actual_{store.find({words_out, 2})},
      sync_in_{store.find(code_sync_in)},
      sync_out_{store.find(code_sync_out)},
      speed_{counts_a_second} {}

DeviceTraits Lenze8400::traits() const noexcept {
  return {.timer = DeviceTraits::Timer::own_raster, .timer_at_sync = true, .produces_sync = true};
}

bool Lenze8400::obeys_own_sync() const noexcept {
  if (firmware_ < obeys_itself) return false;
  if (sync_in_ == nullptr || sync_out_ == nullptr) return true;
  return sync_in_->value == sync_out_->value;
}

std::optional<CobId> Lenze8400::sync_transmit_id() const noexcept {
  if (sync_out_ == nullptr) return {};
  return cob_id(sync_out_->value);
}

void Lenze8400::reset(Time now) noexcept {
  fault_ = false;
  speed_.reset(now);
  publish();
}

bool Lenze8400::enabled() const noexcept {
  return !fault_ && control_ != nullptr && (control_->value & bit_enable) != 0;
}

void Lenze8400::advance(Time now) noexcept {
  speed_.advance(now);
  publish();
}

void Lenze8400::outputs(Time now) noexcept {
  speed_.advance(now);
  if (control_ != nullptr && (control_->value & bit_reset_fault) != 0) fault_ = false;
  speed_.aim(enabled() && set_point_ != nullptr ? set_point_->number() : 0);
  echo(store_, words_in, words_out, first_free_word);
  publish();
}

void Lenze8400::publish() noexcept {
  if (actual_ != nullptr) actual_->set(static_cast<std::uint64_t>(speed_.value()));
  if (status_ == nullptr) return;
  status_->set((fault_ ? status_fault : status_ready) | (enabled() ? status_enabled : 0));
}

/// The drive does not support 29-bit identifiers: bits 11 to 29 have to be 0.
Abort Lenze8400::check_communication(const Object& object, std::uint64_t raw) const noexcept {
  if (is_cob_id(object.key) && (raw & cob_extended) != 0) return Abort::value;
  return Abort::none;
}

/// A write to 0x1005 sets both identifiers; afterwards C00368 may be changed alone.
void Lenze8400::communication_written(const Object& object) noexcept {
  if (object.key != ObjectKey{0x1005, 0}) return;
  if (sync_in_ != nullptr) sync_in_->set(object.value & 0x7FF);
  if (sync_out_ != nullptr) sync_out_->set(object.value & 0x7FF);
}

void Lenze8400::connection_lost(Time now) noexcept {
  speed_.advance(now);
  speed_.aim(0);
}

void Lenze8400::fail(std::uint16_t code, Time now) noexcept {
  fault_ = true;
  outputs(now);
  emcy_.raise(code, ErrorBit::generic);
}

}  // namespace takt::sim
