#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "master/wire/bytes.hpp"
#include "master/wire/frame.hpp"

namespace takt::lss {

/// COB-ID of the frames of the LSS master.
inline constexpr CobId request_cob_id = CobId::base(0x7E5);
/// COB-ID of the frames of LSS slaves.
inline constexpr CobId answer_cob_id = CobId::base(0x7E4);
/// The value that LSS uses for "no node-ID".
inline constexpr std::uint8_t no_node_id = 255;

/// Command specifier, the first byte of a frame. CiA 305, 3.10.
enum class Service : std::uint8_t {
  switch_global = 0x04,
  configure_node_id = 0x11,
  configure_bit_timing = 0x13,
  activate_bit_timing = 0x15,
  store = 0x17,
  select = 0x40,    ///< 0x40..0x43: vendor-ID, product code, revision number, serial number
  selected = 0x44,  ///< answer to `select`
  identify = 0x46,  ///< 0x46..0x4B: vendor-ID, product code, lowest and highest revision number,
                    ///< lowest and highest serial number
  identify_unconfigured = 0x4C,
  identified = 0x4F,    ///< answer to `identify` and to `fast_scan`
  unconfigured = 0x50,  ///< answer to `identify_unconfigured`
  fast_scan = 0x51,
  inquire = 0x5A,  ///< 0x5A..0x5D: vendor-ID, product code, revision number, serial number
  inquire_node_id = 0x5E,
};

/// Makes a request; bytes that a service does not use are zero. `offset` selects the number in
/// `select`, `identify` and `inquire`.
constexpr Frame request(Service service, std::uint32_t value = 0,
                        std::uint8_t offset = 0) noexcept {
  Frame frame{.id = request_cob_id, .length = 8};
  frame.data[0] = static_cast<std::uint8_t>(static_cast<std::uint8_t>(service) + offset);
  store_le(std::span{frame.data}.subspan(1, 4), value);
  return frame;
}

/// One question of the fastscan. CiA 305, 3.9.5.
struct FastScan {
  /// Value of bit_check: all devices without node-ID answer.
  static constexpr std::uint8_t everybody = 0x80;

  std::uint32_t number = 0;
  std::uint8_t bit_check = everybody;  ///< the lowest bit that the devices compare
  std::uint8_t part = 0;  ///< 0 vendor-ID, 1 product code, 2 revision number, 3 serial number
  std::uint8_t next = 0;  ///< the part that the following question compares
  constexpr bool operator==(const FastScan&) const noexcept = default;
};

/// Makes the frame of a fastscan question.
constexpr Frame request(const FastScan& scan) noexcept {
  Frame frame = request(Service::fast_scan, scan.number);
  frame.data[5] = scan.bit_check;
  frame.data[6] = scan.part;
  frame.data[7] = scan.next;
  return frame;
}

/// An answer of a device. The service that was requested determines which fields are valid.
struct Answer {
  std::uint8_t code = 0;      ///< command specifier
  std::uint8_t error = 0;     ///< answers to configure and store: 0 means success
  std::uint8_t specific = 0;  ///< manufacturer-specific code, valid if `error` is 255
  /// The answer to `inquire_...`; `inquire_node_id` uses its lowest byte.
  std::uint32_t number = 0;

  /// Returns true if the answer has the command specifier of this service.
  constexpr bool is(Service service, std::uint8_t offset = 0) const noexcept {
    return code == static_cast<std::uint8_t>(service) + offset;
  }
};

/// Returns the number of bytes of an answer that have a meaning. Some devices send no more than
/// these.
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

/// Decodes an answer. Returns std::nullopt if the frame is no answer of an LSS slave.
constexpr std::optional<Answer> decode_answer(const Frame& frame) noexcept {
  const bool whole = frame.length >= answer_bytes(frame.data[0]);
  if (frame.id != answer_cob_id || frame.rtr || !whole) return {};
  return Answer{frame.data[0], frame.data[1], frame.data[2],
                load_le<std::uint32_t>(std::span{frame.data}.subspan(1))};
}

/// Entries of bit timing table 0 in kbit/s; 0 means reserved or automatic. CiA 305, 3.9.3.
inline constexpr std::array<std::uint16_t, 10> bit_rates{1000, 800, 500, 250, 125,
                                                         0,    50,  20,  10,  0};
/// The entry of bit timing table 0 for automatic bit rate detection.
inline constexpr std::uint8_t automatic_bit_rate = 9;

/// Returns the entry of bit timing table 0 for a bit rate in kbit/s, or std::nullopt if the table
/// has no such entry.
constexpr std::optional<std::uint8_t> bit_rate_index(unsigned kbit) noexcept {
  for (std::uint8_t i = 0; kbit != 0 && i < bit_rates.size(); ++i) {
    if (bit_rates[i] == kbit) return i;
  }
  return {};
}

}  // namespace takt::lss
