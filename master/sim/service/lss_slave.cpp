#include "master/sim/service/lss_slave.hpp"

namespace takt::sim {
namespace {

constexpr Time reaction = std::chrono::microseconds{500};
constexpr Time flash = std::chrono::milliseconds{20};

std::uint32_t word_of(const Frame& frame) noexcept {
  return static_cast<std::uint32_t>(frame.data[1]) |
         static_cast<std::uint32_t>(frame.data[2]) << 8 |
         static_cast<std::uint32_t>(frame.data[3]) << 16 |
         static_cast<std::uint32_t>(frame.data[4]) << 24;
}

/// Bit rates of table 0 in kbit/s; 0 means that the bit rate is not supported.
constexpr std::array<std::uint16_t, 10> table_of_rates{1000, 800, 500, 250, 125, 0, 50, 20, 10, 0};

}  // namespace

LssSlave::LssSlave(ObjectStore& store, std::uint8_t node_id)
    : store_{store}, active_{node_id}, pending_{node_id}, stored_{node_id} {}

void LssSlave::power_on() noexcept {
  active_ = pending_ = stored_;
  rate_ = pending_rate_ = stored_rate_;
  reset();
}

void LssSlave::reset() noexcept {
  active_ = pending_;
  state_ = State::waiting;
  selected_ = in_range_ = scanned_ = 0;
  start_ = switched_ = false;
  switch_at_ = ends_at_ = never;
}

std::uint32_t LssSlave::identity(std::uint8_t part) const noexcept {
  return static_cast<std::uint32_t>(
      store_.number({0x1018, static_cast<std::uint8_t>(part + 1)}, 0));
}

void LssSlave::answer(std::uint8_t command, std::uint32_t value, Time ready,
                      Transmitter& out) noexcept {
  if (faults_.silent) return;
  const auto byte = [value](int n) { return static_cast<std::uint8_t>(value >> (8 * n)); };
  out.send(make_frame(CobId::base(0x7E4), {command, byte(0), byte(1), byte(2), byte(3), 0, 0, 0}),
           ready);
}

void LssSlave::on_frame(const Frame& frame, Time now, Transmitter& out) noexcept {
  if (frame.rtr || frame.length != 8 || switching()) return;
  const std::uint8_t command = frame.data[0];
  if (command == 0x04) {
    if (frame.data[1] <= 1) switch_to(frame.data[1] == 1 ? State::configuration : State::waiting);
  } else if (command >= 0x40 && command <= 0x43) {
    on_select(frame, now, out);
  } else if (command >= 0x46 && command <= 0x4B) {
    on_range(frame, now, out);
  } else if (command == 0x4C) {
    if (without_id()) answer(0x50, 0, now + reaction, out);
  } else if (command == 0x51) {
    on_fast_scan(frame, now, out);
  } else if (state_ == State::configuration) {
    on_configuration(frame, now, out);
  }
}

/// A device without a node-ID starts when it leaves the configuration state with a new node-ID.
void LssSlave::switch_to(State state) noexcept {
  const bool leaves = state_ == State::configuration && state == State::waiting;
  state_ = state;
  selected_ = 0;
  if (leaves && active_ == none && pending_ != none) start_ = true;
}

void LssSlave::on_select(const Frame& frame, Time now, Transmitter& out) noexcept {
  if (state_ != State::waiting) return;
  const auto part = static_cast<std::uint8_t>(frame.data[0] - 0x40);
  if (part == 0) selected_ = 0;
  if (part != selected_ || word_of(frame) != identity(part)) {
    selected_ = 0xFF;  // no match until the next vendor-ID
    return;
  }
  if (++selected_ < 4) return;
  selected_ = 0;
  state_ = State::configuration;
  answer(0x44, 0, now + reaction, out);
}

void LssSlave::on_range(const Frame& frame, Time now, Transmitter& out) noexcept {
  const auto step = static_cast<std::uint8_t>(frame.data[0] - 0x46);
  if (step == 0) in_range_ = 0;
  constexpr std::array<std::uint8_t, 6> part{0, 1, 2, 2, 3, 3};
  const std::uint32_t own = identity(part[step]);
  const std::uint32_t asked = word_of(frame);
  const bool upper = step == 3 || step == 5;
  const bool lower = step == 2 || step == 4;
  const bool fits = upper ? own <= asked : lower ? own >= asked : own == asked;
  if (step != in_range_ || !fits) {
    in_range_ = 0xFF;
    return;
  }
  if (++in_range_ < 6) return;
  in_range_ = 0;
  answer(0x4F, 0, now + reaction, out);
}

void LssSlave::on_fast_scan(const Frame& frame, Time now, Transmitter& out) noexcept {
  if (state_ != State::waiting || !without_id()) return;
  const std::uint8_t bit = frame.data[5];
  const std::uint8_t part = frame.data[6];
  const std::uint8_t next = frame.data[7];
  if (part > 3 || next > 3 || (bit > 31 && bit != 0x80)) return;
  if (bit == 0x80) {
    scanned_ = 0;
    return answer(0x4F, 0, now + reaction, out);
  }
  if (part != scanned_ || ((identity(part) ^ word_of(frame)) >> bit) != 0) return;
  scanned_ = next;
  if (bit == 0 && next < part) state_ = State::configuration;
  answer(0x4F, 0, now + reaction, out);
}

void LssSlave::on_configuration(const Frame& frame, Time now, Transmitter& out) noexcept {
  switch (frame.data[0]) {
    case 0x11:
      return set_node_id(frame.data[1], now, out);
    case 0x13:
      return set_bit_rate(frame.data[1], frame.data[2], now, out);
    case 0x15: {
      const Time pause = std::chrono::milliseconds{frame.data[1] | frame.data[2] << 8};
      switch_at_ = now + pause;
      ends_at_ = now + 2 * pause;
      switched_ = false;
      return;
    }
    case 0x17:
      if (!faults_.refuses_store) {
        stored_ = pending_;
        stored_rate_ = pending_rate_;
      }
      return answer(0x17, faults_.refuses_store ? 2 : 0, now + flash, out);
    case 0x5A:
    case 0x5B:
    case 0x5C:
    case 0x5D:
      return answer(frame.data[0], identity(static_cast<std::uint8_t>(frame.data[0] - 0x5A)),
                    now + reaction, out);
    case 0x5E:
      return answer(0x5E, active_, now + reaction, out);
    default:
      return;
  }
}

void LssSlave::set_node_id(std::uint8_t id, Time now, Transmitter& out) noexcept {
  const bool possible = (id >= 1 && id <= 127) || id == none;
  if (possible) pending_ = id;
  answer(0x11, possible ? 0 : 1, now + reaction, out);
}

void LssSlave::set_bit_rate(std::uint8_t table, std::uint8_t entry, Time now,
                            Transmitter& out) noexcept {
  const std::uint16_t rate =
      table == 0 && entry < table_of_rates.size() ? table_of_rates[entry] : std::uint16_t{0};
  if (rate != 0) pending_rate_ = rate;
  answer(0x13, rate != 0 ? 0 : 1, now + reaction, out);
}

void LssSlave::on_time(Time now) noexcept {
  if (!switching()) return;
  if (!switched_ && now >= switch_at_) {
    rate_ = pending_rate_;
    switched_ = true;
  }
  if (now >= ends_at_) switch_at_ = ends_at_ = never;
}

}  // namespace takt::sim
