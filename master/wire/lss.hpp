#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "master/wire/bytes.hpp"
#include "master/wire/frame.hpp"

namespace takt::lss {

inline constexpr CobId request_cob_id = CobId::base(0x7E5);
inline constexpr CobId answer_cob_id = CobId::base(0x7E4);
/// Node id of a device that has none.
inline constexpr std::uint8_t no_node_id = 255;

/// First byte of a frame. CiA 305, 3.10.
enum class Service : std::uint8_t {
  switch_global = 0x04,
  configure_node_id = 0x11,
  configure_bit_timing = 0x13,
  activate_bit_timing = 0x15,
  store = 0x17,
  select = 0x40,    ///< 0x40..0x43: vendor, product, revision, serial
  selected = 0x44,  ///< answer
  identify = 0x46,  ///< 0x46..0x4B: vendor, product, revision from, to, serial from, to
  identify_unconfigured = 0x4C,
  identified = 0x4F,    ///< answer, to fastscan as well
  unconfigured = 0x50,  ///< answer
  fast_scan = 0x51,
  inquire = 0x5A,  ///< 0x5A..0x5D: vendor, product, revision, serial
  inquire_node_id = 0x5E,
};

/// A request; what a service does not use is zero. `offset`: of select, identify, inquire.
constexpr Frame request(Service service, std::uint32_t value = 0,
                        std::uint8_t offset = 0) noexcept {
  Frame frame{.id = request_cob_id, .length = 8};
  frame.data[0] = static_cast<std::uint8_t>(static_cast<std::uint8_t>(service) + offset);
  store_le(std::span{frame.data}.subspan(1, 4), value);
  return frame;
}

/// One question of the fastscan. CiA 305, 3.9.5.
struct FastScan {
  static constexpr std::uint8_t everybody = 0x80;  ///< bit_check: all without node id answer

  std::uint32_t number = 0;
  std::uint8_t bit_check = everybody;  ///< lowest bit that is compared
  std::uint8_t part = 0;               ///< 0 vendor, 1 product, 2 revision, 3 serial
  std::uint8_t next = 0;               ///< part of the following question
  constexpr bool operator==(const FastScan&) const noexcept = default;
};

constexpr Frame request(const FastScan& scan) noexcept {
  Frame frame = request(Service::fast_scan, scan.number);
  frame.data[5] = scan.bit_check;
  frame.data[6] = scan.part;
  frame.data[7] = scan.next;
  return frame;
}

/// What a device says. Which of the fields count depends on the service that was asked.
struct Answer {
  std::uint8_t code = 0;      ///< first byte
  std::uint8_t error = 0;     ///< configure, store: 0 = done
  std::uint8_t specific = 0;  ///< where `error` is 255
  std::uint32_t number = 0;   ///< inquire

  constexpr bool is(Service service, std::uint8_t offset = 0) const noexcept {
    return code == static_cast<std::uint8_t>(service) + offset;
  }
};

/// Bytes of an answer that say something; some devices send no more.
constexpr std::size_t answer_bytes(std::uint8_t code) noexcept {
  const auto inquire = static_cast<std::uint8_t>(Service::inquire);
  if (code >= inquire && code < inquire + 4) return 5;
  switch (static_cast<Service>(code)) {
    case Service::configure_node_id:
    case Service::configure_bit_timing:
    case Service::store:
    case Service::inquire_node_id:
      return 2;
    default:
      return 1;
  }
}

/// None: no answer of an LSS slave.
constexpr std::optional<Answer> decode_answer(const Frame& frame) noexcept {
  const bool whole = frame.length >= answer_bytes(frame.data[0]);
  if (frame.id != answer_cob_id || frame.rtr || !whole) return {};
  return Answer{frame.data[0], frame.data[1], frame.data[2],
                load_le<std::uint32_t>(std::span{frame.data}.subspan(1))};
}

/// Entries of bit timing table 0 in kbit/s; 0: reserved or automatic. CiA 305, 3.9.3.
inline constexpr std::array<std::uint16_t, 10> bit_rates{1000, 800, 500, 250, 125,
                                                         0,    50,  20,  10,  0};
inline constexpr std::uint8_t automatic_bit_rate = 9;

constexpr std::optional<std::uint8_t> bit_rate_index(unsigned kbit) noexcept {
  for (std::uint8_t i = 0; kbit != 0 && i < bit_rates.size(); ++i) {
    if (bit_rates[i] == kbit) return i;
  }
  return {};
}

}  // namespace takt::lss
