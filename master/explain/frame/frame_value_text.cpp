#include "master/explain/frame/frame_value_text.hpp"

#include <algorithm>
#include <fmt/format.h>

#include "eds_parser/values/raw_number.hpp"
#include "master/wire/bytes.hpp"

namespace takt {
namespace {

std::string number_text(DataType type, unsigned bits, std::uint64_t raw) {
  if (is_real(type)) return fmt::format("{:g}", number_of(type, static_cast<std::int64_t>(raw)));
  return is_signed(type) ? fmt::format("{}", sign_extended(raw, bits)) : fmt::format("{}", raw);
}

/// Returns true for objects of CiA 301, CiA 402 and CiA 401 (digital I/O) whose bits are flags.
bool is_bit_field(ObjectKey object) {
  return object.index == 0x1001 || object.index == 0x1002 ||
         (object.index >= 0x6000 && object.index <= 0x6380);
}

bool printable(std::span<const std::uint8_t> bytes) {
  const auto control = [](std::uint8_t byte) { return byte < 0x20 || byte == 0x7F; };
  return !bytes.empty() && std::ranges::none_of(bytes, control);
}

}  // namespace

std::string value_text(DataType type, std::span<const std::uint8_t> bytes) {
  while (type == DataType::visible_string && !bytes.empty() && bytes.back() == 0) {
    bytes = bytes.first(bytes.size() - 1);
  }
  if (type == DataType::visible_string && printable(bytes)) {
    return fmt::format("\"{}\"", std::string{bytes.begin(), bytes.end()});
  }
  const bool known = !is_bytes(type) && byte_width(type) == bytes.size();
  const bool guessed = type == DataType::unknown && !bytes.empty() && bytes.size() <= 4;
  if (!known && !guessed) return bytes_text(bytes);
  const auto raw = load_le<std::uint64_t>(bytes);
  const auto bits = static_cast<unsigned>(8 * bytes.size());
  std::string text = number_text(type, bits, raw);
  if (!is_signed(type) && !is_real(type) && raw > 9) text += fmt::format(" (0x{:X})", raw);
  return text;
}

std::string value_text(const Signal& signal, std::uint64_t raw) {
  if (!signal.unit.empty() && !is_real(signal.type)) {
    const double counts = is_signed(signal.type)
                              ? static_cast<double>(sign_extended(raw, signal.bits))
                              : static_cast<double>(raw);
    return fmt::format("{:g} {}", counts * signal.scale + signal.offset, signal.unit);
  }
  if (!is_signed(signal.type) && is_bit_field(signal.object)) {
    return fmt::format("0x{:0{}X}", raw, (signal.bits + 3) / 4);
  }
  return number_text(signal.type, signal.bits, raw);
}

}  // namespace takt
