#include "master/explain/frame/error_frame_text.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <string_view>
#include <utility>
#include <vector>

namespace takt {
namespace {

// Numbers of linux/can/error.h. They are repeated here because a recording may be read on a system
// without that header.
constexpr std::uint32_t lost_arbitration = 0x002;
constexpr std::uint32_t controller = 0x004;
constexpr std::uint32_t protocol = 0x008;
constexpr std::uint32_t counters = 0x200;

struct Bit {
  std::uint32_t mask;
  std::string_view text;
};
struct Position {
  std::uint8_t code;
  std::string_view text;
};

constexpr std::array<Bit, 6> classes{{
    {0x001, "a frame could not be sent in time"},
    {0x010, "transceiver fault (wire broken or shorted?)"},
    {0x020, "no node acknowledged a frame (alone on the bus, or the wrong bit rate?)"},
    {0x040, "BUS-OFF: the controller has left the bus"},
    {0x080, "bus error"},
    {0x100, "the controller was restarted"},
}};
constexpr std::array<Bit, 7> controller_bits{{
    {0x01, "receive buffer overflow, frames lost"},
    {0x02, "transmit buffer overflow"},
    {0x04, "receive errors reach the warning level"},
    {0x08, "transmit errors reach the warning level"},
    {0x10, "error-passive by receive errors"},
    {0x20, "error-passive by transmit errors"},
    {0x40, "error-active again"},
}};
constexpr std::array<Bit, 8> protocol_bits{{
    {0x01, "a single bit"},
    {0x02, "frame format"},
    {0x04, "bit stuffing"},
    {0x08, "a dominant bit could not be sent"},
    {0x10, "a recessive bit could not be sent"},
    {0x20, "bus overload"},
    {0x40, "active error announcement"},
    {0x80, "while sending"},
}};
constexpr Position positions[] = {{0x03, "at the start of the frame"},
                                  {0x02, "in the identifier"},
                                  {0x06, "in the identifier"},
                                  {0x07, "in the identifier"},
                                  {0x0E, "in the identifier"},
                                  {0x0F, "in the identifier"},
                                  {0x0A, "in the data"},
                                  {0x0B, "in the length"},
                                  {0x08, "in the CRC"},
                                  {0x18, "in the CRC delimiter"},
                                  {0x19, "in the acknowledge slot"},
                                  {0x1B, "in the acknowledge delimiter"},
                                  {0x1A, "at the end of the frame"},
                                  {0x12, "between two frames"}};

template <std::size_t n>
std::string bits_text(std::uint32_t value, const std::array<Bit, n>& bits) {
  std::vector<std::string_view> set;
  for (const Bit& bit : bits) {
    if ((value & bit.mask) != 0) set.push_back(bit.text);
  }
  return fmt::format("{}", fmt::join(set, ", "));
}

std::string protocol_text(std::uint8_t what, std::uint8_t where) {
  std::string text = bits_text(what, protocol_bits);
  const auto position = std::ranges::find(positions, where, &Position::code);
  if (position != std::end(positions)) {
    text.append(text.empty() ? "" : ", ").append(position->text);
  }
  return text.empty() ? "protocol error" : "protocol error: " + text;
}

}  // namespace

std::string error_frame_text(std::uint32_t error_class, std::span<const std::uint8_t> data) {
  const auto byte = [&](std::size_t i) { return i < data.size() ? data[i] : std::uint8_t{0}; };
  std::vector<std::string> reported;
  if ((error_class & lost_arbitration) != 0) {
    reported.push_back(byte(0) == 0 ? "arbitration lost"
                                    : fmt::format("arbitration lost in bit {}", byte(0)));
  }
  if ((error_class & controller) != 0) {
    std::string text = bits_text(byte(1), controller_bits);
    reported.push_back(text.empty() ? "controller fault" : std::move(text));
  }
  if ((error_class & protocol) != 0) reported.push_back(protocol_text(byte(2), byte(3)));
  std::string rest = bits_text(error_class, classes);
  if (!rest.empty()) reported.push_back(std::move(rest));
  if ((error_class & (controller | counters)) != 0) {
    reported.push_back(fmt::format("error counters: transmit {}, receive {}", byte(6), byte(7)));
  }
  return reported.empty() ? "error frame of the controller"
                          : fmt::format("{}", fmt::join(reported, "; "));
}

}  // namespace takt
