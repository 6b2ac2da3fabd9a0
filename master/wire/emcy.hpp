#pragma once
#include <array>
#include <cstdint>

#include "master/wire/bytes.hpp"
#include "master/wire/frame.hpp"

namespace takt {

/// Emergency message (EMCY) on COB-ID 0x080 + node-ID. CiA 301, 7.2.7.
struct Emcy {
  NodeId node;
  std::uint16_t code = 0;           ///< 0x0000 means "error reset or no error"
  std::uint8_t error_register = 0;  ///< content of object 0x1001
  /// Manufacturer-specific bytes 3..7.
  std::array<std::uint8_t, 5> manufacturer{};
};

/// Returns the COB-ID of the EMCY of a node in the predefined connection set.
constexpr CobId emcy_cob_id(NodeId node) noexcept { return CobId::base(0x080U + node.value()); }

constexpr Frame encode(const Emcy& emcy) noexcept {
  Frame frame{.id = emcy_cob_id(emcy.node), .length = 8};
  store_le(std::span{frame.data}, emcy.code);
  frame.data[2] = emcy.error_register;
  for (std::size_t i = 0; i < emcy.manufacturer.size(); ++i) {
    frame.data[3 + i] = emcy.manufacturer[i];
  }
  return frame;
}

/// Decodes an EMCY of any length; missing bytes count as zero. Its COB-ID may be another one than
/// that of the predefined connection set.
constexpr Emcy emcy_of(NodeId node, const Frame& frame) noexcept {
  std::array<std::uint8_t, 8> bytes{};
  for (std::size_t i = 0; i < frame.length && i < bytes.size(); ++i) bytes[i] = frame.data[i];
  return Emcy{.node = node,
              .code = load_le<std::uint16_t>(std::span{bytes}),
              .error_register = bytes[2],
              .manufacturer = {bytes[3], bytes[4], bytes[5], bytes[6], bytes[7]}};
}

}  // namespace takt
