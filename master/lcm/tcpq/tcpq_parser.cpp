#include "master/lcm/tcpq/tcpq_parser.hpp"

#include "master/lcm/big_endian.hpp"

namespace takt::tcpq {
namespace {

void append_sized(std::vector<std::byte>& out, std::span<const std::byte> bytes) {
  append_be(out, static_cast<std::uint32_t>(bytes.size()));
  out.insert(out.end(), bytes.begin(), bytes.end());
}

}  // namespace

void append(std::vector<std::byte>& out, const Message& message) {
  append_be(out, static_cast<std::uint32_t>(message.type));
  append_sized(out, std::as_bytes(std::span{message.channel}));
  if (message.type == Type::publish) append_sized(out, message.data);
}

void append_opening(std::vector<std::byte>& out, std::uint32_t magic) {
  append_be(out, magic);
  append_be(out, version);
}

void Parser::feed(std::span<const std::byte> bytes) {
  buffer_.erase(buffer_.begin(), buffer_.begin() + static_cast<std::ptrdiff_t>(start_));
  start_ = 0;
  buffer_.insert(buffer_.end(), bytes.begin(), bytes.end());
}

std::optional<std::uint32_t> Parser::number_at(std::size_t at) const noexcept {
  if (buffer_.size() < start_ + at + 4) return std::nullopt;
  return load_be<std::uint32_t>(std::span{buffer_}.subspan(start_ + at));
}

bool Parser::take_opening() noexcept {
  const auto magic = number_at(0);
  if (magic && *magic != expected_magic_) broken_ = true;
  if (broken_ || !number_at(4)) return false;
  start_ += 8;
  opened_ = true;
  return true;
}

std::optional<Message> Parser::fail() noexcept {
  broken_ = true;
  return std::nullopt;
}

std::optional<Message> Parser::next() {
  if (broken_ || (!opened_ && !take_opening())) return std::nullopt;
  const auto type = number_at(0);
  if (!type) return std::nullopt;
  if (*type < 1 || *type > 3) return fail();
  const auto channel_size = number_at(4);
  if (!channel_size) return std::nullopt;
  if (*channel_size > longest_channel) return fail();

  std::size_t end = 8 + *channel_size;
  Message message{.type = static_cast<Type>(*type), .channel = {}, .data = {}};
  std::size_t data_size = 0;
  if (message.type == Type::publish) {
    const auto size = number_at(end);
    if (!size) return std::nullopt;
    if (*size > largest_data) return fail();
    data_size = *size;
    end += 4;
  }
  if (buffer_.size() < start_ + end + data_size) return std::nullopt;
  const std::byte* const begin = buffer_.data() + start_;
  message.channel = {reinterpret_cast<const char*>(begin + 8), *channel_size};
  message.data = {begin + end, data_size};
  start_ += end + data_size;
  return message;
}

}  // namespace takt::tcpq
