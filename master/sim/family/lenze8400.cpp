#include "master/sim/family/lenze8400.hpp"

#include "eds_parser/values/pdo_number.hpp"
#include "master/sim/dictionary/cob_rules.hpp"
#include "master/sim/family/echo.hpp"

namespace takt::sim {
namespace {

constexpr std::uint16_t words_in = 0x5C9D;
constexpr std::uint16_t words_out = 0x5C9B;
constexpr ObjectKey code_sync_in{0x5E90, 0};   // C00367: index 0x5FFF - number
constexpr ObjectKey code_sync_out{0x5E8F, 0};  // C00368

// Bits of the control word.
constexpr std::uint64_t order_on = 0x0001;
constexpr std::uint64_t order_inhibit = 0x0002;
constexpr std::uint64_t order_quick_stop = 0x0004;
constexpr std::uint64_t order_enable = 0x0008;
constexpr std::uint64_t bit_reset_fault = 0x0080;
constexpr std::uint64_t order_halt = 0x0100;

// Bits of the status word, and the states in its bits 8 to 11.
constexpr std::uint64_t shows_no_power = 0x0002;
// Bits for the speed of the ramp, and for that of the motor.
constexpr std::uint64_t shows_speed_reached = 0x0018;
constexpr std::uint64_t shows_standstill = 0x0040;
constexpr std::uint64_t shows_inhibit = 0x0080;
constexpr std::uint64_t shows_ready = 0x0300;
constexpr std::uint64_t shows_switched_on = 0x0400;
constexpr std::uint64_t shows_operation = 0x0500;
constexpr std::uint64_t shows_fault = 0x0800;
constexpr std::int64_t counts_a_second = 16384;  // slope of the ramp: the nominal speed in 1 s

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
  resets_ = false;
  speed_.reset(now);
  publish();
}

bool Lenze8400::enabled() const noexcept {
  constexpr std::uint64_t both = order_on | order_enable;
  return !fault_ && (order() & both) == both && (order() & order_inhibit) == 0;
}

std::uint64_t Lenze8400::order() const noexcept {
  return control_ == nullptr ? 0 : control_->value;
}

void Lenze8400::advance(Time now) noexcept {
  speed_.advance(now);
  publish();
}

void Lenze8400::outputs(Time now) noexcept {
  speed_.advance(now);
  const bool resets = (order() & bit_reset_fault) != 0;
  if (resets && !resets_) fault_ = false;
  resets_ = resets;
  const bool follows =
      enabled() && set_point_ != nullptr && (order() & (order_quick_stop | order_halt)) == 0;
  speed_.aim(follows ? set_point_->number() : 0);
  echo(store_, words_in, words_out, first_free_word);
  publish();
}

void Lenze8400::publish() noexcept {
  if (actual_ != nullptr) actual_->set(static_cast<std::uint64_t>(speed_.value()));
  if (status_ == nullptr) return;
  std::uint64_t word = fault_                      ? shows_fault
                       : enabled()                 ? shows_operation
                       : (order() & order_on) != 0 ? shows_switched_on
                                                   : shows_ready;
  if (!enabled()) word |= shows_inhibit | shows_no_power;
  if (enabled() && speed_.next_change() == never) word |= shows_speed_reached;
  if (speed_.value() == 0) word |= shows_standstill;
  status_->set(word);
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
