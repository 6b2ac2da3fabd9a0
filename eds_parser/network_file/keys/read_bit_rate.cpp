#include <algorithm>
#include <array>

#include "eds_parser/network_file/keys/sections.hpp"

namespace takt {
namespace {

constexpr std::array<std::uint32_t, 9> standard_rates{10, 20, 50, 100, 125, 250, 500, 800, 1000};

bool is_standard_rate(std::uint32_t kbit) {
  return std::ranges::find(standard_rates, kbit) != standard_rates.end();
}

}  // namespace

void read_bit_rate(const KeyInput& in, Sourced<std::uint32_t>& out) {
  Sourced<std::uint32_t> rate;
  set(in, rate);
  if (!rate.given) return;
  const std::string written = "`" + std::string{in.key.name} + "` is in kbit/s";
  const std::uint32_t kbit = *rate / 1000;
  const bool is_bits = *rate > 1000 && *rate % 1000 == 0 && is_standard_rate(kbit);
  if (is_bits && in.key.name == "baudrate") {
    in.report().warning(rate.pos, "unit", written, ": ", *rate,
                        " is read as bit/s, CAN allows at most 1000 kbit/s; write ", kbit);
    rate.value = kbit;
  } else if (*rate > 1000) {
    return in.error("unit", written, ": ", *rate, " would be ", kbit,
                    " Mbit/s; CAN allows at most 1000 kbit/s",
                    is_bits ? ", write " + std::to_string(kbit) : "");
  } else if (!is_standard_rate(*rate)) {
    in.report().warning(rate.pos, "bit-rate", written, " and ", *rate,
                        " is not a CANopen bit rate (10, 20, 50, 100, 125, 250, 500, 800, 1000)");
  }
  if (out.given && *rate != *out) {
    in.error("bit-rate", "`baudrate` of `master` and `bitrate_kbit` of `bus` differ: keep one");
  }
  out = rate;
}

}  // namespace takt
