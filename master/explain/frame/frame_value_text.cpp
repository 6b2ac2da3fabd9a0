#include "master/explain/frame/frame_value_text.hpp"

#include <bit>
#include <fmt/format.h>

#include "master/wire/bytes.hpp"

namespace takt {
namespace {

std::int64_t signed_value(std::uint64_t raw, unsigned bits) {
  const unsigned unused = 64 - bits;
  return static_cast<std::int64_t>(raw << unused) >> unused;
}

std::string number_text(DataType type, unsigned bits, std::uint64_t raw) {
  if (type == DataType::real32) {
    return fmt::format("{:g}", std::bit_cast<float>(static_cast<std::uint32_t>(raw)));
  }
  if (type == DataType::real64) return fmt::format("{:g}", std::bit_cast<double>(raw));
  if (is_signed(type)) return fmt::format("{}", signed_value(raw, bits));
  return fmt::format("{}", raw);
}

/// Returns true for objects of CiA 301, CiA 402 and CiA 401 whose bits are flags.
bool is_bit_field(ObjectKey object) {
  switch (object.index) {
    case 0x1001:
    case 0x1002:
    case 0x6040:
    case 0x6041:
    case 0x60FD:
    case 0x60FE:
      return true;
    default:
      return object.index >= 0x6000 && object.index <= 0x6380;  // CiA 401: digital I/O
  }
}

bool printable(std::span<const std::uint8_t> bytes) {
  for (const std::uint8_t byte : bytes) {
    if (byte < 0x20 || byte == 0x7F) return false;
  }
  return !bytes.empty();
}

}  // namespace

std::string bytes_text(std::span<const std::uint8_t> bytes) {
  return fmt::format("{:02X}", fmt::join(bytes, " "));
}

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
                              ? static_cast<double>(signed_value(raw, signal.bits))
                              : static_cast<double>(raw);
    return fmt::format("{:g} {}", counts * signal.scale + signal.offset, signal.unit);
  }
  if (!is_signed(signal.type) && is_bit_field(signal.object)) {
    return fmt::format("0x{:0{}X}", raw, (signal.bits + 3) / 4);
  }
  return number_text(signal.type, signal.bits, raw);
}

}  // namespace takt
