#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "eds_parser/values/ids.hpp"
#include "master/wire/bytes.hpp"
#include "master/wire/frame.hpp"
#include "master/wire/sdo_codec.hpp"

namespace takt {

// Frames of SDO block transfers. CiA 301, 7.2.4.3.9 to 7.2.4.3.16. The parameter `channel` of the
// functions below is the COB-ID on which the sender of the frame transmits.

/// The largest number of segments in a sub-block.
inline constexpr std::uint8_t most_block_segments = 127;
/// Data bytes of one segment.
inline constexpr std::size_t segment_bytes = 7;

/// Returns true for 1..127, the permitted number of segments of a sub-block.
constexpr bool valid_block_size(std::uint8_t segments) noexcept {
  return segments >= 1 && segments <= most_block_segments;
}

/// Initiate frame of the side that sends the data: the client in a download, the server in an
/// upload.
struct SdoBlockInitiate {
  ObjectKey object;
  bool crc = false;                     ///< this side supports the CRC
  std::optional<std::uint32_t> size{};  ///< std::nullopt if the size is not indicated; bytes
};

/// Initiate frame of the side that receives the data.
struct SdoBlockAccept {
  ObjectKey object;
  bool crc = false;
  std::uint8_t segments = 0;  ///< size of the next sub-block
  /// Only in upload requests: protocol switch threshold in bytes; 0 means never switch.
  std::uint8_t threshold = 0;
};

/// One segment. The last segment of a transfer is padded; the end frame indicates how many of its
/// bytes are unused.
struct SdoBlockSegment {
  std::uint8_t number = 0;  ///< sequence number, 1..127
  bool last = false;
  std::array<std::uint8_t, segment_bytes> data{};
};

/// Confirmation of a sub-block by the side that receives.
struct SdoBlockConfirm {
  std::uint8_t received = 0;  ///< sequence number of the last segment that was received in sequence
  std::uint8_t segments = 0;  ///< size of the next sub-block, in segments

  bool operator==(const SdoBlockConfirm&) const = default;
};

/// End of a block transfer.
struct SdoBlockEnd {
  std::uint8_t unused = 0;  ///< bytes of the last segment that carry no data, 0..7
  std::uint16_t crc = 0;
};

namespace sdo_detail {

constexpr Frame bare(CobId channel, std::uint8_t command) noexcept {
  return frame(channel, command, {});
}

constexpr Frame block_begin(CobId channel, const SdoBlockInitiate& begin) noexcept {
  const unsigned command = 0xC0U | (begin.crc ? 4U : 0U) | (begin.size ? 2U : 0U);
  Frame out = frame(channel, static_cast<std::uint8_t>(command), begin.object);
  store_le(std::span{out.data}.subspan(4), begin.size.value_or(0));
  return out;
}

constexpr Frame block_accept(CobId channel, const SdoBlockAccept& accept) noexcept {
  Frame out =
      frame(channel, static_cast<std::uint8_t>(0xA0U | (accept.crc ? 4U : 0U)), accept.object);
  out.data[4] = accept.segments;
  out.data[5] = accept.threshold;
  return out;
}

}  // namespace sdo_detail

// Frames of the side that sends the data: the client in a download, the server in an upload.

constexpr Frame block_initiate(CobId channel, const SdoBlockInitiate& begin) noexcept {
  return sdo_detail::block_begin(channel, begin);
}

/// Makes the next segment from the bytes that are still to be sent.
template <WireByte B>
constexpr Frame block_segment(CobId channel, std::uint8_t number, std::span<B> left) noexcept {
  Frame out{.id = channel, .length = 8};
  out.data[0] = static_cast<std::uint8_t>(number | (left.size() <= segment_bytes ? 0x80U : 0U));
  const std::size_t size = std::min(left.size(), segment_bytes);
  for (std::size_t i = 0; i < size; ++i) out.data[1 + i] = static_cast<std::uint8_t>(left[i]);
  return out;
}

constexpr Frame block_end(CobId channel, const SdoBlockEnd& end) noexcept {
  Frame out = sdo_detail::bare(
      channel, static_cast<std::uint8_t>(0xC1U | static_cast<unsigned>(end.unused) << 2U));
  store_le(std::span{out.data}.subspan(1), end.crc);
  return out;
}

// Frames of the side that receives the data.

constexpr Frame block_accept(CobId channel, const SdoBlockAccept& accept) noexcept {
  return sdo_detail::block_accept(channel, accept);
}
constexpr Frame block_upload_start(CobId channel) noexcept {
  return sdo_detail::bare(channel, 0xA3);
}
constexpr Frame block_confirm(CobId channel, const SdoBlockConfirm& confirm) noexcept {
  Frame out = sdo_detail::bare(channel, 0xA2);
  out.data[1] = confirm.received;
  out.data[2] = confirm.segments;
  return out;
}
constexpr Frame block_end_confirm(CobId channel) noexcept {
  return sdo_detail::bare(channel, 0xA1);
}

// Classification of a received frame. Several of these functions may accept the same frame; the
// state of the transfer decides which of them applies.

constexpr bool is_block_initiate(const Frame& frame) noexcept {
  return (frame.data[0] & 0xE1) == 0xC0;
}
constexpr bool is_block_end(const Frame& frame) noexcept { return (frame.data[0] & 0xE1) == 0xC1; }
constexpr bool is_block_accept(const Frame& frame) noexcept {
  return (frame.data[0] & 0xE3) == 0xA0;
}
constexpr bool is_block_end_confirm(const Frame& frame) noexcept {
  return (frame.data[0] & 0xE3) == 0xA1;
}
constexpr bool is_block_confirm(const Frame& frame) noexcept {
  return (frame.data[0] & 0xE3) == 0xA2;
}
constexpr bool is_block_upload_start(const Frame& frame) noexcept {
  return (frame.data[0] & 0xE3) == 0xA3;
}

constexpr SdoBlockInitiate decode_block_initiate(const Frame& frame) noexcept {
  SdoBlockInitiate begin{.object = sdo_object(frame), .crc = (frame.data[0] & 4) != 0};
  if ((frame.data[0] & 2) != 0) {
    begin.size = load_le<std::uint32_t>(std::span{frame.data}.subspan(4));
  }
  return begin;
}
constexpr SdoBlockAccept decode_block_accept(const Frame& frame) noexcept {
  return {.object = sdo_object(frame),
          .crc = (frame.data[0] & 4) != 0,
          .segments = frame.data[4],
          .threshold = frame.data[5]};
}
constexpr SdoBlockSegment decode_block_segment(const Frame& frame) noexcept {
  SdoBlockSegment part{.number = static_cast<std::uint8_t>(frame.data[0] & 0x7F),
                       .last = (frame.data[0] & 0x80) != 0};
  std::ranges::copy(std::span{frame.data}.subspan(1), part.data.begin());
  return part;
}
constexpr SdoBlockConfirm decode_block_confirm(const Frame& frame) noexcept {
  return {.received = frame.data[1], .segments = frame.data[2]};
}
constexpr SdoBlockEnd decode_block_end(const Frame& frame) noexcept {
  return {.unused = static_cast<std::uint8_t>(frame.data[0] >> 2 & 7),
          .crc = load_le<std::uint16_t>(std::span{frame.data}.subspan(1))};
}

}  // namespace takt
