#include "eds_parser/plan/image/signal_rules.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "eds_parser/dictionary/integer_of.hpp"
#include "eds_parser/plan/image/speed_axes.hpp"
#include "eds_parser/specification/object_units.hpp"

namespace takt {
namespace {

constexpr std::int64_t quick_stop_bits = 0x0002;
constexpr std::int64_t disable_voltage_command = 0x0000;
constexpr std::chrono::milliseconds default_time_to_live{50};

enum class Role : std::uint8_t { other, controlword, mode, position_target, rate_target };

Role role_of(ObjectKey object) {
  // These are the target velocity of mode vl, the target torque, the offsets of position, velocity
  // and torque, and the target velocity of the modes pv and csv.
  constexpr std::array<std::uint16_t, 6> rates{0x6042, 0x6071, 0x60B0, 0x60B1, 0x60B2, 0x60FF};
  const std::uint16_t index = first_axis(object.index);
  if (index == 0x6040) return Role::controlword;
  if (index == 0x6060) return Role::mode;
  if (index == 0x607A || index == 0x60C1) return Role::position_target;
  return std::ranges::find(rates, index) != rates.end() ? Role::rate_target : Role::other;
}

/// Returns a configured value as the process image stores it. A real number is stored as its bit
/// pattern.
std::int64_t raw_value(const SdoSpec& sdo, DataType type) {
  const std::int64_t* integer = sdo.integer();
  const auto* real = std::get_if<double>(&sdo.value);
  if (integer == nullptr && real == nullptr) return 0;
  const double number = integer != nullptr ? static_cast<double>(*integer) : *real;
  if (type == DataType::real32) return std::bit_cast<std::int32_t>(static_cast<float>(number));
  if (type == DataType::real64) return std::bit_cast<std::int64_t>(number);
  if (integer != nullptr) return *integer;
  return std::abs(number) < 0x1p63 ? static_cast<std::int64_t>(number) : 0;
}

std::optional<std::int64_t> written_value(const std::vector<SdoSpec>& list, const Signal& signal) {
  const auto sdo = std::ranges::find(list.rbegin(), list.rend(), signal.object, &SdoSpec::object);
  return sdo == list.rend() ? std::nullopt : std::optional{raw_value(*sdo, signal.type)};
}

/// Returns the value of an output before its first command: the entry of `safe_values`. Without
/// one, the controlword and the rates of a drive are 0, and other outputs get the value that `sdo:`
/// or the DCF writes. For a target position of a drive there is no value except that of
/// `safe_values`; without it the axis stays at its actual position.
std::optional<std::int64_t> safe_value(const NodeSource& node, bool cia402, const Signal& signal) {
  if (auto value = written_value(node.spec->safe_values, signal)) return value;
  const Role role = role_of(signal.object);
  if (cia402 && role == Role::position_target) return {};
  if (cia402 && (role == Role::controlword || role == Role::rate_target)) return 0;
  if (auto value = written_value(node.spec->sdo, signal)) return value;
  const SubObject* sub = node.dictionary->find(signal.object);
  return sub == nullptr ? std::nullopt : integer_of(sub->parameter_value);
}

void set_value(Signal& signal, std::int64_t value) {
  signal.fallback = Fallback::value;
  signal.fallback_value = value;
}

void stop_axis(Signal& signal, std::int64_t controlword) {
  const Role role = role_of(signal.object);
  if (role == Role::controlword) set_value(signal, controlword);
  if (role == Role::rate_target) set_value(signal, 0);
}

}  // namespace

void apply_units(const NodeSource& node, Signal& signal) {
  for (const ObjectUnitSpec& object : node.spec->units.objects) {
    if (object.object != signal.object) continue;
    signal.scale = *object.unit.scale * object.unit.sign;
    signal.offset = object.unit.offset;
    signal.unit = object.unit.unit;
    return;
  }
  const auto quantity = quantity_of(signal.object);
  if (!quantity) return;
  const auto& unit = node.spec->units.of(quantity->quantity);
  if (!unit) return;
  signal.scale = *unit->scale * (quantity->directed ? unit->sign : 1);
  signal.offset = quantity->absolute || quantity->quantity != Quantity::position ? unit->offset : 0;
  signal.unit = unit->unit;
}

std::uint32_t fallback_cycles(const TimeoutSpec& timeout, Time period) {
  const Time after =
      timeout.after.given ? std::chrono::milliseconds{*timeout.after} : Time{default_time_to_live};
  const std::uint32_t cycles =
      timeout.after_cycles.given ? *timeout.after_cycles
                                 : static_cast<std::uint32_t>((after + period - Time{1}) / period);
  return cycles == 0 ? 0 : std::max(fewest_fallback_cycles, cycles);
}

void apply_fallback(const NodeSource& node, bool cia402, Time period, Signal& signal) {
  const TimeoutSpec& timeout = node.spec->on_timeout;
  const auto policy =
      timeout.fallback.value_or(cia402 ? FallbackPolicy::quick_stop : FallbackPolicy::hold);
  signal.fallback_cycles = fallback_cycles(timeout, period);
  if (timeout.after_cycles.given) signal.fallback_key = TimeToLiveKey::after_cycles;
  signal.safe_value = safe_value(node, cia402, signal);
  switch (policy) {
    case FallbackPolicy::hold:
      break;
    case FallbackPolicy::quick_stop:
      stop_axis(signal, quick_stop_bits);
      break;
    case FallbackPolicy::disable:
      stop_axis(signal, disable_voltage_command);
      break;
    case FallbackPolicy::zero: {
      const Role role = role_of(signal.object);
      const bool keeps = cia402 && (role == Role::position_target || role == Role::mode);
      if (!keeps) set_value(signal, 0);
      break;
    }
    case FallbackPolicy::safe:
      if (signal.safe_value) set_value(signal, *signal.safe_value);
      break;
  }
}

std::optional<ObjectKey> seed_object(ObjectKey output) noexcept {
  const std::uint16_t first = first_axis(output.index);
  const auto input = [&](std::uint16_t object) {
    return ObjectKey{static_cast<std::uint16_t>(object + output.index - first), 0};
  };
  if (first == 0x607A && output.sub == 0) return input(0x6064);
  if (first == 0x60C1 && output.sub == 1) return input(0x6064);
  if (first == 0x6060 && output.sub == 0) return input(0x6061);
  return std::nullopt;
}

void check_fallback(const NodeSource& node, bool cia402, NetworkReport& report) {
  const auto& fallback = node.spec->on_timeout.fallback;
  const bool needs_drive =
      *fallback == FallbackPolicy::quick_stop || *fallback == FallbackPolicy::disable;
  if (fallback.given && needs_drive && !cia402 && !has_speed_words(node)) {
    report.error(
        fallback.pos, "fallback", "node `", node.spec->name,
        "` is not a CiA 402 drive and no speed axis, and has no quick stop or disable: write "
        "hold, zero or safe (`profile: cia402` makes the node a drive)");
  }
  if (fallback.given && *fallback == FallbackPolicy::safe && node.spec->safe_values.empty()) {
    report.error(fallback.pos, "fallback", "`fallback: safe` of node `", node.spec->name,
                 "` needs `safe_values: [{index: ..., sub_index: ..., value: ...}]`");
  }
}

}  // namespace takt
