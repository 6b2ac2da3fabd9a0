#include "master/sim/bus/frame_bits.hpp"

#include <array>

namespace takt::sim {
namespace {

constexpr std::uint32_t polynomial = 0x4599;

constexpr std::size_t most_bytes = 13;  ///< a 29-bit header and eight data bytes

/// CRC of a byte, by the number of bytes that follow it. The CRC begins at 0 and is linear, so the
/// CRC of a row of bytes is the XOR of the CRCs of its bytes.
constexpr auto crc_table = [] {
  std::array<std::array<std::uint16_t, 256>, most_bytes> table{};
  for (std::uint32_t byte = 0; byte < 256; ++byte) {
    std::uint32_t crc = byte << 7;
    for (std::size_t following = 0; following < most_bytes; ++following) {
      for (int bit = 0; bit < 8; ++bit) {
        crc <<= 1;
        if ((crc & 0x8000) != 0) crc ^= 0x8000 | polynomial;
      }
      table[following][byte] = static_cast<std::uint16_t>(crc);
    }
  }
  return table;
}();

/// A run of equal bits: last bit * 4 + (length of the run - 1), length 1..4.
using Run = std::uint8_t;
constexpr Run runs = 8;

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

/// Stuff bits are counted in units of 256, so that sums of table entries need no division: the runs
/// of all steps of a frame add up to less than one unit.
constexpr std::uint32_t one_stuff_bit = 256;

/// Stuff bits and next run, for each 1 to 8 bits (with a leading one bit as length mark) and for
/// each run before them. The run is the last index, because the next step waits for it.
constexpr auto run_table = [] {
  std::array<std::array<std::uint16_t, runs>, 512> table{};
  for (Run start = 0; start < runs; ++start) {
    table[1][start] = start;
    for (std::uint32_t marked = 2; marked < 512; ++marked) {
      const std::uint16_t before = table[marked >> 1][start];
      const RunStep step = follow(before % runs, (marked & 1) != 0);
      const std::uint32_t stuffed = before / one_stuff_bit + step.stuffed;
      table[marked][start] = static_cast<std::uint16_t>(stuffed * one_stuff_bit + step.run);
    }
  }
  return table;
}();

/// Computes CRC and stuff bits of a row of bits that grows behind SOF (0).
class BitRow {
 public:
  /// `bytes` is the number of calls of head() and byte() that follow.
  explicit BitRow(std::size_t bytes) noexcept : following_{bytes} {}

  /// Appends the lowest `count` bits, 1..8, as the first ones: leading zeros do not change the CRC.
  void head(std::uint32_t bits, int count) noexcept {
    crc_ ^= crc_table[--following_][bits];
    stuff(bits, count);
  }
  void byte(std::uint32_t value) noexcept { head(value & 0xFF, 8); }
  /// Appends `count` bits that the CRC does not cover.
  void stuff(std::uint32_t bits, int count) noexcept {
    const std::uint32_t step = run_table[1u << count | bits][run_];
    run_ = step % runs;
    steps_ += step;
  }
  std::uint32_t crc() const noexcept { return crc_; }
  std::uint32_t stuffed() const noexcept { return steps_ / one_stuff_bit; }

 private:
  std::size_t following_;
  std::uint32_t crc_ = 0;
  std::uint32_t steps_ = 0;  ///< sum of the table entries
  std::uint32_t run_ = 0;
};

/// Appends 18 bits: identifier, RTR, IDE, r0, DLC.
void base_header(BitRow& row, const Frame& frame) noexcept {
  const std::uint32_t bits =
      frame.id.id() << 7 | static_cast<std::uint32_t>(frame.rtr) << 6 | frame.length;
  row.head(bits >> 16, 2);
  row.byte(bits >> 8);
  row.byte(bits);
}

/// Appends 38 bits: identifier, SRR, IDE, identifier, RTR, r1, r0, DLC.
void extended_header(BitRow& row, const Frame& frame) noexcept {
  const std::uint64_t id = frame.id.id();
  const std::uint64_t bits = (id >> 18) << 27 | std::uint64_t{3} << 25 | (id & 0x3'FFFF) << 7 |
                             static_cast<std::uint64_t>(frame.rtr) << 6 | frame.length;
  row.head(static_cast<std::uint32_t>(bits >> 32), 6);
  for (int shift = 24; shift >= 0; shift -= 8) row.byte(static_cast<std::uint32_t>(bits >> shift));
}

}  // namespace

FrameBits frame_bits(const Frame& frame) noexcept {
  const bool extended = frame.id.is_extended();
  const std::uint32_t bytes = frame.rtr ? 0 : frame.length;
  BitRow row{(extended ? 5u : 3u) + bytes};
  if (extended) {
    extended_header(row, frame);
  } else {
    base_header(row, frame);
  }
#pragma GCC unroll 8
  for (std::uint32_t i = 0; i < bytes; ++i) row.byte(frame.data[i]);
  const std::uint32_t crc = row.crc();
  row.stuff(crc >> 8, 7);
  row.stuff(crc & 0xFF, 8);
  const std::uint32_t plain = (extended ? 64u : 44u) + 8 * bytes;
  return {.crc = static_cast<std::uint16_t>(crc),
          .stuff = static_cast<std::uint16_t>(row.stuffed()),
          .total = static_cast<std::uint16_t>(plain + row.stuffed())};
}

}  // namespace takt::sim
