#include "master/sim/bus/frame_bits.hpp"

#include <array>
#include <utility>

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
constexpr std::uint32_t runs = 8;

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

/// An entry of the table below. The lowest byte is a number of stuff bits, so the sum of the
/// entries of a frame gives the number of its stuff bits. The bits above this byte are the run with
/// which the frame continues: they select the row of the next entry.
using Step = std::uint16_t;
constexpr std::uint32_t one_row = 256;
constexpr std::uint32_t row_mask = (runs - 1) * one_row;

/// Stuff bits and next run, for each run and each `count` bits that follow it.
template <int count>
constexpr auto steps = [] {
  std::array<Step, std::size_t{runs} << count> table{};
  for (std::size_t i = 0; i < table.size(); ++i) {
    RunStep step{static_cast<Run>(i >> count), 0};
    std::uint32_t stuffed = 0;
    for (int bit = count - 1; bit >= 0; --bit) {
      step = follow(step.run, (i >> bit & 1) != 0);
      stuffed += step.stuffed;
    }
    table[i] = static_cast<Step>(step.run * one_row + stuffed);
  }
  return table;
}();

/// Computes CRC and stuff bits of a row of bits that grows behind SOF (0).
class BitRow {
 public:
  /// `bytes` is the number of calls of add() that follow.
  explicit BitRow(std::size_t bytes) noexcept : following_{bytes} {}

  /// Appends `count` bits, 1..8. Fewer than 8 bits are permitted only in the first call, because
  /// leading zeros do not change the CRC.
  template <int count = 8>
  void add(std::uint32_t bits) noexcept {
    crc_ ^= crc_table[--following_][bits];
    stuff<count>(bits);
  }
  /// Appends `count` bits that the CRC does not cover.
  template <int count = 8>
  void stuff(std::uint32_t bits) noexcept {
    step_ = steps<count>[(step_ & row_mask) >> (8 - count) | bits];
    sum_ += step_;
  }
  std::uint32_t crc() const noexcept { return crc_; }
  std::uint32_t stuffed() const noexcept { return sum_ % one_row; }

 private:
  std::size_t following_;
  std::uint32_t crc_ = 0;
  std::uint32_t sum_ = 0;  ///< sum of the table entries
  std::uint32_t step_ = 0;
};

/// Appends 18 bits: identifier, RTR, IDE, r0, DLC.
[[gnu::always_inline]] inline void base_header(BitRow& row, const Frame& frame) noexcept {
  const std::uint32_t bits =
      frame.id.id() << 7 | static_cast<std::uint32_t>(frame.rtr) << 6 | frame.length;
  row.add<2>(bits >> 16);
  row.add(bits >> 8 & 0xFF);
  row.add(bits & 0xFF);
}

/// Appends 38 bits: identifier, SRR, IDE, identifier, RTR, r1, r0, DLC.
[[gnu::always_inline]] inline void extended_header(BitRow& row, const Frame& frame) noexcept {
  const std::uint64_t id = frame.id.id();
  const std::uint64_t bits = (id >> 18) << 27 | std::uint64_t{3} << 25 | (id & 0x3'FFFF) << 7 |
                             static_cast<std::uint64_t>(frame.rtr) << 6 | frame.length;
  row.add<6>(static_cast<std::uint32_t>(bits >> 32));
  for (int shift = 24; shift >= 0; shift -= 8) row.add(bits >> shift & 0xFF);
}

/// Counts the bits of a frame of this kind. The number of data bytes is a constant, so that the
/// compiler unrolls the loop and knows the rows of crc_table.
template <bool extended, std::uint32_t bytes>
FrameBits count(const Frame& frame) noexcept {
  BitRow row{(extended ? 5u : 3u) + bytes};
  extended ? extended_header(row, frame) : base_header(row, frame);
#pragma GCC unroll 8
  for (std::uint32_t i = 0; i < bytes; ++i) row.add(frame.data[i]);
  const std::uint32_t crc = row.crc();
  row.stuff<7>(crc >> 8);
  row.stuff(crc & 0xFF);
  const std::uint32_t plain = (extended ? 64u : 44u) + 8 * bytes;
  return {.total = static_cast<std::uint16_t>(plain + row.stuffed()),
          .stuff = static_cast<std::uint16_t>(row.stuffed()),
          .crc = static_cast<std::uint16_t>(crc)};
}

/// The functions count(), indexed by the number of data bytes.
template <bool extended>
constexpr auto counts = []<std::size_t... bytes>(std::index_sequence<bytes...>) {
  return std::array{&count<extended, bytes>...};
}(std::make_index_sequence<9>{});

}  // namespace

FrameBits frame_bits(const Frame& frame) noexcept {
  const std::size_t bytes = frame.rtr ? 0 : frame.length;
  return frame.id.is_extended() ? counts<true>[bytes](frame) : counts<false>[bytes](frame);
}

}  // namespace takt::sim
