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

namespace takt {

// Frames of expedited and segmented SDO transfers. CiA 301, 7.2.4.3. All frames are sent with eight
// bytes, and unused bytes are sent as zero. Unused bytes of received frames are ignored and may be
// missing.

/// Returns the COB-ID of the frames of a client on the default channel of a server.
constexpr CobId sdo_request_cob_id(NodeId server) noexcept {
  return CobId::base(0x600U + server.value());
}
/// Returns the COB-ID of the frames of a server on its default channel.
constexpr CobId sdo_answer_cob_id(NodeId server) noexcept {
  return CobId::base(0x580U + server.value());
}

/// COB-ID of a client's frames, either given or that of the default channel of a server.
struct SdoRequestId {
  CobId value;
  constexpr SdoRequestId(NodeId server) noexcept : value{sdo_request_cob_id(server)} {}
  constexpr SdoRequestId(CobId id) noexcept : value{id} {}
};
/// COB-ID of a server's frames, either given or that of the default channel of a server.
struct SdoAnswerId {
  CobId value;
  constexpr SdoAnswerId(NodeId server) noexcept : value{sdo_answer_cob_id(server)} {}
  constexpr SdoAnswerId(CobId id) noexcept : value{id} {}
};

/// Client command specifier, bits 7..5 of byte 0.
enum class SdoRequest : std::uint8_t {
  download_segment = 0,
  download_initiate = 1,
  upload_initiate = 2,
  upload_segment = 3,
  abort = 4,
  block_upload = 5,
  block_download = 6,
  reserved = 7,
};

/// Server command specifier, bits 7..5 of byte 0.
enum class SdoAnswer : std::uint8_t {
  upload_segment = 0,
  download_segment = 1,
  upload_initiate = 2,
  download_initiate = 3,
  abort = 4,
  block_download = 5,
  block_upload = 6,
  reserved = 7,
};

/// Returns the client command specifier of a frame.
constexpr SdoRequest sdo_request(const Frame& frame) noexcept {
  return static_cast<SdoRequest>(frame.data[0] >> 5);
}
/// Returns the server command specifier of a frame.
constexpr SdoAnswer sdo_answer(const Frame& frame) noexcept {
  return static_cast<SdoAnswer>(frame.data[0] >> 5);
}

/// Returns the index and sub-index in an initiate frame or an abort.
constexpr ObjectKey sdo_object(const Frame& frame) noexcept {
  return {load_le<std::uint16_t>(std::span{frame.data}.subspan(1)), frame.data[3]};
}

/// Initiate frame of the side that sends the data: the client in a download, the server in an
/// upload. It carries up to four bytes itself (expedited transfer); for longer values it only
/// indicates the size.
struct SdoInitiate {
  ObjectKey object;
  bool expedited = false;
  std::optional<std::uint32_t> size{};  ///< std::nullopt if the size is not indicated; bytes
  std::array<std::uint8_t, 4> data{};   ///< only valid in expedited transfers

  /// Returns the expedited data. These are all four bytes if the size is not indicated.
  constexpr std::span<const std::uint8_t> payload() const noexcept {
    return std::span{data}.first(std::min<std::size_t>(size.value_or(4), 4));
  }
};

/// One segment with up to seven bytes.
struct SdoSegment {
  bool toggle = false;
  bool last = false;
  std::uint8_t size = 0;  ///< number of data bytes, 0..7
  std::array<std::uint8_t, 7> data{};

  constexpr std::span<const std::uint8_t> payload() const noexcept {
    return std::span{data}.first(size);
  }
};

namespace sdo_detail {

constexpr Frame frame(CobId id, std::uint8_t command, ObjectKey object) noexcept {
  Frame out{.id = id, .length = 8};
  out.data[0] = command;
  store_le(std::span{out.data}.subspan(1), object.index);
  out.data[3] = object.sub;
  return out;
}

constexpr Frame initiate(CobId id, std::uint8_t specifier, const SdoInitiate& begin) noexcept {
  unsigned command = specifier | (begin.expedited ? 2U : 0U) | (begin.size ? 1U : 0U);
  if (begin.expedited && begin.size) command |= (4U - (*begin.size & 7U)) << 2;
  Frame out = frame(id, static_cast<std::uint8_t>(command), begin.object);
  if (begin.expedited) {
    std::ranges::copy(begin.payload(), out.data.begin() + 4);
  } else {
    store_le(std::span{out.data}.subspan(4), begin.size.value_or(0));
  }
  return out;
}

constexpr Frame segment(CobId id, const SdoSegment& part) noexcept {
  Frame out{.id = id, .length = 8};
  out.data[0] = static_cast<std::uint8_t>((part.toggle ? 0x10U : 0U) | (7U - part.size) << 1 |
                                          (part.last ? 1U : 0U));
  std::ranges::copy(part.payload(), out.data.begin() + 1);
  return out;
}

}  // namespace sdo_detail

/// Makes the initiate frame for a value: expedited for 1..4 bytes, else segmented.
template <WireByte B>
constexpr SdoInitiate sdo_initiate(ObjectKey object, std::span<B> value) noexcept {
  SdoInitiate begin{.object = object,
                    .expedited = !value.empty() && value.size() <= 4,
                    .size = static_cast<std::uint32_t>(value.size())};
  for (std::size_t i = 0; begin.expedited && i < value.size(); ++i) {
    begin.data[i] = static_cast<std::uint8_t>(value[i]);
  }
  return begin;
}

/// Makes the next segment from the bytes that are still to be sent.
template <WireByte B>
constexpr SdoSegment sdo_segment(std::span<B> left, bool toggle) noexcept {
  SdoSegment part{.toggle = toggle,
                  .last = left.size() <= 7,
                  .size = static_cast<std::uint8_t>(std::min<std::size_t>(left.size(), 7))};
  for (std::size_t i = 0; i < part.size; ++i) part.data[i] = static_cast<std::uint8_t>(left[i]);
  return part;
}

// Frames from client to server.

constexpr Frame upload_request(SdoRequestId channel, ObjectKey object) noexcept {
  return sdo_detail::frame(channel.value, 0x40, object);
}
constexpr Frame upload_segment_request(SdoRequestId channel, bool toggle) noexcept {
  return sdo_detail::frame(channel.value, toggle ? 0x70 : 0x60, {});
}
constexpr Frame download_request(SdoRequestId channel, const SdoInitiate& begin) noexcept {
  return sdo_detail::initiate(channel.value, 0x20, begin);
}
constexpr Frame download_segment_request(SdoRequestId channel, const SdoSegment& part) noexcept {
  return sdo_detail::segment(channel.value, part);
}

// Frames from server to client.

constexpr Frame upload_answer(SdoAnswerId channel, const SdoInitiate& begin) noexcept {
  return sdo_detail::initiate(channel.value, 0x40, begin);
}
constexpr Frame upload_segment_answer(SdoAnswerId channel, const SdoSegment& part) noexcept {
  return sdo_detail::segment(channel.value, part);
}
constexpr Frame download_answer(SdoAnswerId channel, ObjectKey object) noexcept {
  return sdo_detail::frame(channel.value, 0x60, object);
}
constexpr Frame download_segment_answer(SdoAnswerId channel, bool toggle) noexcept {
  return sdo_detail::frame(channel.value, toggle ? 0x30 : 0x20, {});
}

// Frames in both directions.

/// Makes an abort. `channel` is the COB-ID on which the sender transmits: sdo_request_cob_id if the
/// client aborts, sdo_answer_cob_id if the server does.
constexpr Frame sdo_abort(CobId channel, ObjectKey object, std::uint32_t code) noexcept {
  Frame out = sdo_detail::frame(channel, 0x80, object);
  store_le(std::span{out.data}.subspan(4), code);
  return out;
}
constexpr std::uint32_t sdo_abort_code(const Frame& frame) noexcept {
  return load_le<std::uint32_t>(std::span{frame.data}.subspan(4));
}

/// Decodes the initiate frame of a download request or of an upload answer.
constexpr SdoInitiate decode_initiate(const Frame& frame) noexcept {
  SdoInitiate begin{.object = sdo_object(frame), .expedited = (frame.data[0] & 2) != 0};
  std::ranges::copy(std::span{frame.data}.subspan(4), begin.data.begin());
  if ((frame.data[0] & 1) != 0) {
    begin.size = begin.expedited ? 4U - (frame.data[0] >> 2 & 3U)
                                 : load_le<std::uint32_t>(std::span{begin.data});
  }
  return begin;
}

/// Decodes a download segment request or an upload segment answer.
constexpr SdoSegment decode_segment(const Frame& frame) noexcept {
  SdoSegment part{.toggle = (frame.data[0] & 0x10) != 0,
                  .last = (frame.data[0] & 1) != 0,
                  .size = static_cast<std::uint8_t>(7 - (frame.data[0] >> 1 & 7))};
  std::ranges::copy(std::span{frame.data}.subspan(1), part.data.begin());
  return part;
}

/// Returns the toggle bit of any segment frame, request or answer.
constexpr bool sdo_toggle(const Frame& frame) noexcept { return (frame.data[0] & 0x10) != 0; }

/// Returns the number of bytes of a server's frame that have a meaning, except for segments of a
/// block upload. Some devices send no more than these.
constexpr std::size_t sdo_answer_bytes(const Frame& frame) noexcept {
  const unsigned subcommand = frame.data[0] & 3U;
  switch (sdo_answer(frame)) {
    case SdoAnswer::upload_segment:
      return 1U + decode_segment(frame).size;
    case SdoAnswer::upload_initiate: {
      const SdoInitiate begin = decode_initiate(frame);
      if (!begin.expedited) return 4;
      return 4 + begin.size.value_or(1);
    }
    case SdoAnswer::download_initiate:
    case SdoAnswer::abort:
      return 4;
    case SdoAnswer::block_download:  // initiate with a block size, confirmation of the end, or
                                     // confirmation of a sub-block
      return subcommand == 0 ? 5 : (subcommand == 1 ? 1 : 3);
    case SdoAnswer::block_upload:  // initiate, or end with the CRC
      return subcommand == 0 ? 4 : 3;
    case SdoAnswer::download_segment:
    case SdoAnswer::reserved:
      break;
  }
  return 1;
}

}  // namespace takt
