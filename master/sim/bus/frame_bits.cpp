#include "master/sim/bus/frame_bits.hpp"

#include <array>

namespace takt::sim {
namespace {

constexpr std::uint32_t polynomial = 0x4599;

constexpr std::array<std::uint16_t, 256> crc_table = [] {
  std::array<std::uint16_t, 256> table{};
  for (std::uint32_t byte = 0; byte < 256; ++byte) {
    std::uint32_t crc = byte << 7;
    for (int bit = 0; bit < 8; ++bit) {
      crc <<= 1;
      if ((crc & 0x8000) != 0) crc ^= 0x8000 | polynomial;
    }
    table[byte] = static_cast<std::uint16_t>(crc & 0x7FFF);
  }
  return table;
}();

/// A run of equal bits: last bit * 4 + (length of the run - 1), length 1..4.
using Run = std::uint8_t;

struct RunStep {
  Run run = 0;
  std::uint8_t stuffed = 0;
};

constexpr RunStep follow(Run run, bool bit) {
  const bool last = run >= 4;
  const int length = run % 4 + 1;
  if (bit != last) return {static_cast<Run>(bit ? 4 : 0), 0};
  if (length < 4) return {static_cast<Run>(run + 1), 0};
  return {static_cast<Run>(bit ? 0 : 4), 1};  // the stuff bit begins a new run
}

/// The next run and the stuff bits for each run and each 1 to 8 bits (with a leading one bit as
/// length mark).
constexpr auto run_table = [] {
  std::array<std::array<RunStep, 512>, 8> table{};
  for (Run start = 0; start < 8; ++start) {
    for (std::uint32_t marked = 2; marked < 512; ++marked) {
      int length = 8;
      while ((marked >> length) == 0) --length;
      RunStep all{start, 0};
      for (int bit = length - 1; bit >= 0; --bit) {
        const RunStep step = follow(all.run, ((marked >> bit) & 1) != 0);
        all = {step.run, static_cast<std::uint8_t>(all.stuffed + step.stuffed)};
      }
      table[start][marked] = all;
    }
  }
  return table;
}();

/// Computes CRC and stuff bits of a growing row of bits, which already contains SOF.
class BitRow {
 public:
  void byte(std::uint32_t value) noexcept {
    check(value);
    stuff(value, 8);
  }
  void check(std::uint32_t value) noexcept {
    crc_ = ((crc_ << 8) ^ crc_table[((crc_ >> 7) ^ value) & 0xFF]) & 0x7FFF;
  }
  /// Appends the lowest `count` bits, 1..8.
  void stuff(std::uint32_t bits, int count) noexcept {
    const std::uint32_t mark = 1u << count;
    const RunStep step = run_table[run_][mark | (bits & (mark - 1))];
    run_ = step.run;
    stuffed_ = stuffed_ + step.stuffed;
  }
  std::uint32_t crc() const noexcept { return crc_; }
  std::uint32_t stuffed() const noexcept { return stuffed_; }

 private:
  std::uint32_t crc_ = 0;
  std::uint32_t stuffed_ = 0;
  Run run_ = 0;
};

/// SOF (0) and 18 bits: leading zeros do not change the CRC.
void base_header(BitRow& row, const Frame& frame) noexcept {
  const std::uint32_t bits =
      frame.id.id() << 7 | static_cast<std::uint32_t>(frame.rtr) << 6 | frame.length;
  row.check(bits >> 16);
  row.check(bits >> 8);
  row.check(bits);
  row.stuff(bits >> 16, 2);
  row.stuff(bits >> 8, 8);
  row.stuff(bits, 8);
}

/// SOF (0) and 38 bits: identifier, SRR, IDE, identifier, RTR, r1, r0, DLC.
void extended_header(BitRow& row, const Frame& frame) noexcept {
  const std::uint64_t id = frame.id.id();
  const std::uint64_t bits = (id >> 18) << 27 | std::uint64_t{3} << 25 | (id & 0x3'FFFF) << 7 |
                             static_cast<std::uint64_t>(frame.rtr) << 6 | frame.length;
  for (int shift = 32; shift >= 0; shift -= 8) {
    const auto part = static_cast<std::uint32_t>(bits >> shift);
    row.check(part);
    row.stuff(part, shift == 32 ? 6 : 8);
  }
}

}  // namespace

FrameBits frame_bits(const Frame& frame) noexcept {
  const bool extended = frame.id.is_extended();
  const std::uint32_t bytes = frame.rtr ? 0 : frame.length;
  BitRow row;
  if (extended) {
    extended_header(row, frame);
  } else {
    base_header(row, frame);
  }
  for (std::uint32_t i = 0; i < bytes; ++i) row.byte(frame.data[i]);
  const std::uint32_t crc = row.crc();
  row.stuff(crc >> 8, 7);
  row.stuff(crc, 8);
  const std::uint32_t plain = (extended ? 64u : 44u) + 8 * bytes;
  return {.crc = static_cast<std::uint16_t>(crc),
          .stuff = static_cast<std::uint16_t>(row.stuffed()),
          .total = static_cast<std::uint16_t>(plain + row.stuffed())};
}

}  // namespace takt::sim
