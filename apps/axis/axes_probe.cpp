#include <fmt/format.h>

#include "apps/axis/axes_state.hpp"
#include "apps/axis/group/signal_format.hpp"

// Touch probes: the drive stores its position at an edge. CiA 402-2, 0x60B8 to 0x60BD.

namespace takt {
namespace {

constexpr std::uint16_t function_object = 0x60B8;
constexpr std::uint16_t status_object = 0x60B9;
constexpr std::uint16_t first_position = 0x60BA;  // position of input 1 at its rising edge
// Bits of the touch probe function and status for input 1. Those of input 2 are 8 bits higher.
constexpr unsigned armed = 0x01;
constexpr unsigned by_index_pulse = 0x04;
constexpr unsigned at_rising = 0x10;
constexpr unsigned at_falling = 0x20;
constexpr unsigned rising_stored = 0x02;
constexpr unsigned falling_stored = 0x04;
constexpr unsigned bits_of_input = 0xFF;
/// Number of cycles between two requests to the drive.
constexpr std::int64_t probe_pause = 5;

}  // namespace

/// Returns a value of an axis from the image if a PDO has it, and otherwise by SDO.
std::expected<std::int64_t, Obstacle> Axes::State::read_of_axis(Index axis, std::uint16_t index) {
  const Object object = object_of_axis(axis, index);
  if (const auto place = place_of(object, Signals::all)) return group.input().values()[*place];
  const auto data = transfer("sdo_upload", object, {});
  if (!data) return std::unexpected{data.error()};
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < data->size() && i < sizeof(bits); ++i) {
    bits |= std::uint64_t{(*data)[i]} << (8 * i);
  }
  return static_cast<std::int64_t>(bits);
}

/// Waits until the bits `bits` of the touch probe status have the value `wanted`.
Done Axes::State::wait_for_probe(Index axis, unsigned bits, unsigned wanted,
                                 std::chrono::nanoseconds longest) {
  const auto begin = Clock::now();
  while (true) {
    const auto status = read_of_axis(axis, status_object);
    if (!status) return std::unexpected{status.error()};
    if ((static_cast<unsigned>(*status) & bits) == wanted) return {};
    if (Clock::now() - begin >= longest) {
      return obstacle(
          Obstacle::Kind::time_over,
          fmt::format("{}: no edge has come in {:.1f} s: 0x60B9 is 0x{:04X}",
                      group.axes().name(axis), std::chrono::duration<double>(longest).count(),
                      static_cast<std::uint16_t>(*status)));
    }
    const std::int64_t cycle = group.input().cycle();
    const auto paused =
        wait_until([&] { return group.input().cycle() >= cycle + probe_pause; }, options.longest);
    if (paused && !*paused) return *paused;
  }
}

std::expected<double, Obstacle> Axes::State::touch_probe(Index number, const ProbeOptions& wanted) {
  if (number < 0 || number >= size() || wanted.input < 1 || wanted.input > 2) {
    return obstacle(Obstacle::Kind::wrong_use,
                    fmt::format("axis {} of {}, input {} of 2", number, size(), wanted.input));
  }
  if (!is_current()) return std::unexpected{restarted().error()};
  const Index axis = in_group(number);
  const unsigned shift = wanted.input == 1 ? 0 : 8;
  const bool rises = wanted.edge == ProbeOptions::Edge::rising;
  const auto before = read_of_axis(axis, function_object);
  if (!before) return std::unexpected{before.error()};
  const unsigned others = static_cast<unsigned>(*before) & 0xFFFF & ~(bits_of_input << shift);
  const unsigned source = wanted.source == ProbeOptions::Source::index_pulse ? by_index_pulse : 0;
  const unsigned function = armed | source | (rises ? at_rising : at_falling);
  const unsigned stored = rises ? rising_stored : falling_stored;
  const auto write = [&](unsigned word) {
    return write_of_axis(axis, function_object, word, sizeof(std::uint16_t));
  };
  Done done = write(others);
  if (done) done = wait_for_probe(axis, armed << shift, 0, options.longest);
  if (done) done = write(others | function << shift);
  if (done) {
    const unsigned bits = (armed | stored) << shift;
    done = wait_for_probe(axis, bits, bits, wanted.longest);
  }
  const auto place = static_cast<std::uint16_t>(first_position + 2 * (wanted.input - 1) + !rises);
  std::expected<std::int64_t, Obstacle> counts{0};
  if (done) counts = read_of_axis(axis, place);
  // Only the first obstacle is reported.
  [[maybe_unused]] const Done disarmed = is_current() ? write(others) : Done{};
  if (!done) return std::unexpected{done.error()};
  if (!counts) return std::unexpected{counts.error()};
  const double position = static_cast<std::int32_t>(*counts);
  const AxisSignals& known = group.axes().signals(axis);
  const auto unit = known.position ? known.position : known.target_position;
  if (!unit) return position;
  const ValueFormat format = format_of(group.input().signals()[*unit]);
  return position * format.scale + format.offset;
}

}  // namespace takt
