#pragma once
#include <chrono>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <expected>
#include <span>
#include <string>
#include <string_view>
#include <takt/command_t.hpp>
#include <takt/event_t.hpp>
#include <takt/image_t.hpp>
#include <takt/layout_t.hpp>
#include <takt/motion_command_t.hpp>
#include <takt/motion_gear_t.hpp>
#include <takt/motion_stream_t.hpp>
#include <takt/motion_t.hpp>
#include <takt/pdo_status_t.hpp>
#include <takt/reply_t.hpp>
#include <takt/request_t.hpp>
#include <takt/speed_axes_t.hpp>
#include <takt/status_t.hpp>
#include <takt/sync_status_t.hpp>
#include <takt/timing_t.hpp>
#include <takt/transfer_state_t.hpp>
#include <takt/transfer_t.hpp>
#include <vector>

#include "master/lcm/big_endian.hpp"
#include "master/lcm/message_shape.hpp"

namespace takt {

/// Version of all messages; their field `schema` carries it.
inline constexpr std::int16_t message_schema = 2;

/// Largest message, if the sender can choose: one Ethernet frame with LCM's header and channel
/// name.
inline constexpr std::size_t message_bytes = 1300;

/// Longest time between the arrivals of one message by two paths.
inline constexpr std::chrono::milliseconds echo_limit{50};

using Bytes = std::span<const std::byte>;

/// Reason why bytes are not the expected message.
enum class DecodeFault : std::uint8_t {
  schema_1,       ///< the fingerprint is that of this type in schema 1
  other_version,  ///< another fingerprint: the publisher uses other .lcm files
  malformed,      ///< sizes in the message are inconsistent
  out_of_range,   ///< the message has a number that no raw value can represent
};

std::string_view text(DecodeFault fault) noexcept;

/// Returns the text of the daemon for an application whose messages have another schema.
std::string schema_refusal(std::int16_t schema);
/// Returns the text of a program that receives messages of a daemon with another schema.
std::string daemon_schema_text(std::int16_t schema);

/// Fingerprint of a type in schema 1; 0 if the type has not changed since.
template <class T>
inline constexpr std::uint64_t fingerprint_of_schema_1 =
    std::same_as<T, command_t>  ? 0xE6CF45B76FC2022E
    : std::same_as<T, image_t>  ? 0x802677B48765DA81
    : std::same_as<T, status_t> ? 0xB1E043970713C28C
                                : 0;

/// Returns the layout of the bytes of a type, see has_shape.
template <class T>
consteval std::string_view message_layout() {
  if (std::same_as<T, command_t>) return "lhllslibn(i)(l)";
  if (std::same_as<T, event_t>) return "lhllhsshs";
  if (std::same_as<T, image_t>) return "llhhhlllin(l)n(i)";
  if (std::same_as<T, layout_t>) return "lhhhllliiin(shsihbhhsdd)";
  if (std::same_as<T, motion_command_t>) return "lhllslissin(sbdddddd)";
  if (std::same_as<T, motion_gear_t>) return "lhllsliisbsddsn(sbdddddd)(d)(d)(d)";
  if (std::same_as<T, motion_stream_t>) return "lhllsliin(sbdddddd)ln(dn(d)(d)n(d))";
  if (std::same_as<T, motion_t>) return "lhhhlln(hbbiibbbidddddddbd)";
  if (std::same_as<T, pdo_status_t>) return "lhhhlln(hhbibhllbibhllll)";
  if (std::same_as<T, sync_status_t>) return "lhlhshllllls";
  if (std::same_as<T, reply_t>) return "lhllsblsn(b)";
  if (std::same_as<T, request_t>) return "lhllsshihhin(b)";
  if (std::same_as<T, speed_axes_t>)
    return "lhhhlln(shbbiiiiiiiiiiin(i)in(i)in(i)in(i)in(i)in(i)sdddd)";
  if (std::same_as<T, status_t>)
    return "lhhhlssislllllllllllllfhhhhslhhbbbbbbllllbn(hshhhhihiiiiilsn(i))";
  if (std::same_as<T, timing_t>) return "lhlln(slffffn(l))";
  if (std::same_as<T, transfer_t>) return "lhllsshihilln(b)";
  if (std::same_as<T, transfer_state_t>) return "lhllssllllsln(b)";
  return {};
}

/// Returns the bytes as the element type that the generated messages use.
inline std::span<const std::uint8_t> octets(Bytes bytes) noexcept {
  return {reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()};
}

/// Numbers the messages that together hold one list.
template <class T>
void number_parts(std::vector<T>& messages) {
  for (std::size_t part = 0; part < messages.size(); ++part) {
    messages[part].part = static_cast<std::int16_t>(part);
    messages[part].parts = static_cast<std::int16_t>(messages.size());
  }
}

/// Decodes bytes from outside. Whatever the bytes contain, the effort is at most proportional to
/// their number.
template <class T>
std::expected<T, DecodeFault> decode(Bytes bytes) {
  if (bytes.size() < 8 || bytes.size() > 0x7FFF'FFFF) {
    return std::unexpected{DecodeFault::malformed};
  }
  const auto fingerprint = load_be<std::uint64_t>(bytes);
  if (fingerprint != static_cast<std::uint64_t>(T::getHash())) {
    const bool old = fingerprint != 0 && fingerprint == fingerprint_of_schema_1<T>;
    return std::unexpected{old ? DecodeFault::schema_1 : DecodeFault::other_version};
  }
  T message;
  if (!has_shape(bytes.subspan(8), message_layout<T>()) ||
      message.decode(bytes.data(), 0, static_cast<int>(bytes.size())) < 0) {
    return std::unexpected{DecodeFault::malformed};
  }
  return message;
}

/// Encodes the message into a buffer that the caller reuses.
template <class T>
Bytes encode(const T& message, std::vector<std::byte>& buffer) {
  const int size = message.getEncodedSize();
  buffer.resize(static_cast<std::size_t>(size));
  const int written = message.encode(buffer.data(), 0, size);
  return Bytes{buffer}.first(written < 0 ? 0 : static_cast<std::size_t>(written));
}

}  // namespace takt
