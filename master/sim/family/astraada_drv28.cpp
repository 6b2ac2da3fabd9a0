#include "master/sim/family/astraada_drv28.hpp"

#include "master/sim/family/echo.hpp"

namespace takt::sim {
namespace {

constexpr std::uint16_t request = 0x2100;
constexpr std::uint16_t response = 0x2000;
constexpr std::uint16_t commands = 0x2101;
constexpr std::uint16_t states = 0x2001;

constexpr std::uint64_t read_value = 1;
constexpr std::uint64_t write_ram = 2;
constexpr std::uint16_t no_request = 0;
constexpr std::uint16_t done = 1;
constexpr std::uint16_t failed = 3;

// Values of the low byte of the control word, then of the status word.
constexpr std::uint64_t run_forward = 1;
constexpr std::uint64_t run_reverse = 2;
constexpr std::uint64_t stop_by_ramp = 5;
constexpr std::uint64_t coast = 6;
constexpr std::uint64_t reset_fault = 7;
constexpr std::uint64_t runs_forward = 1;
constexpr std::uint64_t runs_reverse = 2;
constexpr std::uint64_t stopped = 3;
constexpr std::uint64_t faulty = 4;

constexpr std::int64_t slope = 2500;  // 50 Hz in 2 s

bool is_tpdo(std::uint16_t index) noexcept { return index >= 0x1800 && index <= 0x1803; }

}  // namespace

AstraadaDrv28::AstraadaDrv28(ObjectStore& store, EmcyProducer& emcy)
    : Model{emcy},
      store_{store},
      slots_{.request_code = store.find({request, 1}),
             .request_address = store.find({request, 2}),
             .request_data = store.find({request, 3}),
             .response_code = store.find({response, 1}),
             .response_error = store.find({response, 2}),
             .response_data = store.find({response, 3}),
             .control = store.find({commands, 1}),
             .set_point = store.find({commands, 2}),
             .status = store.find({states, 1}),
             .frequency = store.find({states, 2})},
      frequency_{slope} {}

DeviceTraits AstraadaDrv28::traits() const noexcept {
  return {.timer = DeviceTraits::Timer::alone,
          .answers_255 = true,
          .reports_state_at_start = false,
          .answers_rtr = false,
          .inhibit_unit = std::chrono::milliseconds{1},
          .inhibit_floor = std::chrono::milliseconds{50}};
}

/// The inverter does not support the types 0, 252 and 253. TPDO1 only answers RPDO1, so its type is
/// 255 and its event timer is 0.
Abort AstraadaDrv28::check_communication(const Object& object, std::uint64_t raw) const noexcept {
  if (!is_tpdo(object.key.index)) return Abort::none;
  const bool first = object.key.index == 0x1800;
  if (object.key.sub == 2) {
    const bool known = (raw >= 1 && raw <= 240) || raw == 254 || raw == 255;
    return !known || (first && raw != 255) ? Abort::value : Abort::none;
  }
  if (object.key.sub == 5 && first && raw != 0) return Abort::value;
  return Abort::none;
}

bool AstraadaDrv28::complete() const noexcept {
  for (const Object* slot : {slots_.request_code, slots_.request_address, slots_.request_data,
                             slots_.response_code, slots_.response_error, slots_.response_data,
                             slots_.control, slots_.set_point, slots_.status, slots_.frequency}) {
    if (slot == nullptr) return false;
  }
  return true;
}

void AstraadaDrv28::reset(Time now) noexcept {
  parameters_.reset();
  frequency_.reset(now);
  fault_ = false;
  publish();
}

void AstraadaDrv28::advance(Time now) noexcept {
  frequency_.advance(now);
  publish();
}

void AstraadaDrv28::outputs(Time now) noexcept {
  frequency_.advance(now);
  command();
  echo(store_, commands, states, first_free_word);
  echo(store_, commands + 1, states + 1);
  echo(store_, commands + 2, states + 2);
  publish();
}

void AstraadaDrv28::command() noexcept {
  if (!complete()) return;
  const std::uint64_t order = slots_.control->value & 0xFF;
  const auto wanted = static_cast<std::int64_t>(slots_.set_point->value);
  if (order == reset_fault) fault_ = false;
  if (fault_ || order == coast) return frequency_.drop();
  if (order == run_forward) frequency_.aim(wanted);
  if (order == run_reverse) frequency_.aim(-wanted);
  if (order == stop_by_ramp) frequency_.aim(0);
}

void AstraadaDrv28::publish() noexcept {
  if (!complete()) return;
  const std::int64_t now = frequency_.value();
  slots_.frequency->set(static_cast<std::uint64_t>(now < 0 ? -now : now));
  slots_.status->set(fault_ ? faulty : now > 0 ? runs_forward : now < 0 ? runs_reverse : stopped);
}

void AstraadaDrv28::received(std::uint16_t rpdo, Time now) noexcept {
  if (rpdo != 1 || !complete()) return;
  frequency_.advance(now);
  serve_request();
}

bool AstraadaDrv28::takes_short(std::uint16_t rpdo) noexcept {
  if (rpdo != 1 || !complete()) return false;
  respond(failed, {.error = Drv28Error::frame});
  return true;
}

void AstraadaDrv28::serve_request() noexcept {
  const auto address = static_cast<std::uint16_t>(slots_.request_address->value);
  switch (slots_.request_code->value) {
    case 0:
      return respond(no_request, {});
    case read_value:
      return respond(done, parameters_.read(address));
    case write_ram: {
      const auto value = static_cast<std::uint32_t>(slots_.request_data->value);
      return respond(done, parameters_.write(address, value, running()));
    }
    default:
      return respond(failed, {.error = Drv28Error::invalid_command});
  }
}

void AstraadaDrv28::respond(std::uint16_t code, Drv28Parameters::Answer answer) noexcept {
  slots_.response_code->set(answer.error == Drv28Error::none ? code : failed);
  slots_.response_error->set(static_cast<std::uint16_t>(answer.error));
  slots_.response_data->set(answer.value);
}

void AstraadaDrv28::connection_lost(Time now) noexcept {
  frequency_.advance(now);
  frequency_.aim(0);
}

void AstraadaDrv28::fail(std::uint16_t code, Time now) noexcept {
  fault_ = true;
  outputs(now);
  emcy_.raise(code, ErrorBit::manufacturer);
}

}  // namespace takt::sim
