#include "apps/takt/live/text/signal_text.hpp"

#include <algorithm>
#include <fmt/format.h>

#include "apps/takt/live/text/quantity.hpp"
#include "eds_parser/values/raw_number.hpp"

namespace takt {
namespace {

constexpr unsigned most_shown_bits = 16;
constexpr std::size_t whole_unit = 16;
constexpr std::size_t short_unit = 6;

DataType type_of(const signal_t& signal) { return static_cast<DataType>(signal.data_type); }

unsigned bits_of(const signal_t& signal) {
  return static_cast<unsigned>(std::clamp<int>(signal.bits, 1, 64));
}

std::uint64_t pattern(const signal_t& signal, std::int64_t raw) {
  const unsigned bits = bits_of(signal);
  return static_cast<std::uint64_t>(raw) & (bits == 64 ? ~0ULL : (1ULL << bits) - 1);
}

/// Returns true for inputs and outputs each of whose bits is one digital line: CiA 401, 0x6000 to
/// 0x63FF, and CiA 402, 0x60FD and 0x60FE.
bool is_digital(const signal_t& signal) {
  if (!signal.unit.empty() || is_real(type_of(signal))) return false;
  const std::int32_t in_axis = 0x6000 + (signal.index & 0x7FF);
  const bool drive = signal.index >= 0x6000 && (in_axis == 0x60FD || in_axis == 0x60FE);
  const bool lines = signal.index == 0x6000 || signal.index == 0x6100 || signal.index == 0x6120 ||
                     signal.index == 0x6200 || signal.index == 0x6300 || signal.index == 0x6320 ||
                     type_of(signal) == DataType::boolean;
  return drive || lines;
}

std::string hex(const signal_t& signal, std::int64_t raw) {
  return fmt::format("{:0{}X}", pattern(signal, raw), (bits_of(signal) + 3) / 4);
}

std::string number(const signal_t& signal, std::int64_t raw, std::size_t unit_width) {
  if (!signal.unit.empty()) {
    const double value = number_of(type_of(signal), raw) * signal.scale + signal.offset;
    return quantity_text({.value = value, .unit = signal.unit}, 11, unit_width);
  }
  if (is_real(type_of(signal))) return fmt::format("{:g}", number_of(type_of(signal), raw));
  if (type_of(signal) == DataType::unsigned64) return std::to_string(pattern(signal, raw));
  return std::to_string(raw);
}

}  // namespace

std::string long_value(const signal_t& signal, std::int64_t raw) {
  const unsigned bits = bits_of(signal);
  if (!is_digital(signal) || bits > most_shown_bits) return number(signal, raw, whole_unit);
  std::string text;
  for (unsigned bit = bits; bit-- > 0;) {
    text += (pattern(signal, raw) >> bit & 1U) != 0 ? '1' : '0';
    if (bit != 0 && bit % 4 == 0) text += ' ';
  }
  return text;
}

std::string short_value(const signal_t& signal, std::int64_t raw) {
  return is_digital(signal) ? hex(signal, raw) : number(signal, raw, short_unit);
}

std::string raw_text(const signal_t& signal, std::int64_t raw) {
  if (is_real(type_of(signal))) return fmt::format("{:g}", number_of(type_of(signal), raw));
  return hex(signal, raw);
}

}  // namespace takt
