#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace takt {

/// LCM's tcpq:// protocol, version 1.0. All numbers have 32 bits and are big endian. Each side
/// opens with a magic number and the version. Messages follow: type, length, channel, and for
/// `publish` another length and the data. A server sends only `publish`.
namespace tcpq {

inline constexpr std::uint32_t magic_server = 0x2876'17FA;
inline constexpr std::uint32_t magic_client = 0x2876'17FB;
inline constexpr std::uint32_t version = 0x0100;
inline constexpr std::uint16_t default_port = 7700;
/// LCM channels have at most 63 characters; patterns may be longer.
inline constexpr std::size_t longest_channel = 255;
inline constexpr std::size_t largest_data = 1 << 20;

enum class Type : std::uint32_t { publish = 1, subscribe = 2, unsubscribe = 3 };

struct Message {
  Type type = Type::publish;
  std::string_view channel;
  std::span<const std::byte> data;
};

/// Appends one message.
void append(std::vector<std::byte>& out, const Message& message);
/// Appends the opening of one side.
void append_opening(std::vector<std::byte>& out, std::uint32_t magic);

/// Splits the stream of the other side into messages. Holds at most one message and the bytes of
/// one read.
class Parser {
 public:
  explicit Parser(std::uint32_t expected_magic) noexcept : expected_magic_{expected_magic} {}

  void feed(std::span<const std::byte> bytes);
  /// Returns the next whole message. It points into the parser and is valid until the next call.
  std::optional<Message> next();
  /// Returns true if the other side does not use this protocol or sent a message above the size
  /// limit.
  bool broken() const noexcept { return broken_; }
  bool opened() const noexcept { return opened_; }

 private:
  std::optional<std::uint32_t> number_at(std::size_t at) const noexcept;
  bool take_opening() noexcept;
  std::optional<Message> fail() noexcept;

  std::uint32_t expected_magic_;
  std::vector<std::byte> buffer_;
  std::size_t start_ = 0;  // start of the bytes that are not yet taken
  bool opened_ = false;
  bool broken_ = false;
};

}  // namespace tcpq
}  // namespace takt
