#include "master/gateway/message/typed_channels.hpp"

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <utility>

#include "master/gateway/message/image_messages.hpp"

namespace takt {
namespace {

constexpr std::size_t longest_sender = 256;

std::vector<ValueFormat> formats_of(const BusPlan& plan) {
  std::vector<ValueFormat> formats;
  for (const Signal& signal : plan.layout.signals) {
    formats.push_back({signal.type, signal.bits, signal.scale, signal.offset});
  }
  return formats;
}

/// Takes values from the front of a message. After the end of the message, every further call
/// fails.
class Taker {
 public:
  explicit Taker(Bytes bytes) : bytes_{bytes} {}

  template <class T>
  T take() {
    return load_be<T>(next(sizeof(T)));
  }
  std::string text() {
    const auto length = take<std::int32_t>();
    if (length < 1 || static_cast<std::size_t>(length) > longest_sender) good_ = false;
    const Bytes part = good_ ? next(static_cast<std::size_t>(length)) : Bytes{};
    if (part.empty() || part.back() != std::byte{0}) good_ = false;
    std::string text;
    for (const std::byte byte : part) text += std::to_integer<char>(byte);
    if (!text.empty()) text.pop_back();
    return text;
  }
  /// Returns true if every value was present and no bytes are left.
  bool whole() const noexcept { return good_ && bytes_.empty(); }

 private:
  Bytes next(std::size_t size) {
    if (!good_ || bytes_.size() < size) {
      good_ = false;
      return {};
    }
    const Bytes part = bytes_.first(size);
    bytes_ = bytes_.subspan(size);
    return part;
  }

  Bytes bytes_;
  bool good_ = true;
};

/// A number of the message: integers as they are, floats and doubles in SI units.
struct Number {
  std::int64_t integer = 0;
  std::optional<double> real{};
};

Number take_number(Taker& from, LcmPrimitive type) {
  switch (type) {
    case LcmPrimitive::boolean:
    case LcmPrimitive::int8:
      return {.integer = from.take<std::int8_t>()};
    case LcmPrimitive::int16:
      return {.integer = from.take<std::int16_t>()};
    case LcmPrimitive::int32:
      return {.integer = from.take<std::int32_t>()};
    case LcmPrimitive::int64:
    case LcmPrimitive::string:
      return {.integer = from.take<std::int64_t>()};
    case LcmPrimitive::float32:
      return {.real = std::bit_cast<float>(from.take<std::uint32_t>())};
    case LcmPrimitive::float64:
      return {.real = std::bit_cast<double>(from.take<std::uint64_t>())};
  }
  return {};
}

/// Returns the fingerprint of the command in schema 1, which has no fields `instance` and
/// `release`.
std::uint64_t fingerprint_of_schema_1_of(TypedMessage command) {
  std::erase_if(command.fields, [](const TypedField& field) {
    return !field.signal && (field.name == "instance" || field.name == "release");
  });
  return command.fingerprint();
}

bool is_stale(const ImageView& image, const TypedMessage& type) noexcept {
  return std::ranges::any_of(type.fields, [&](const TypedField& field) {
    return field.signal && is_stale(image, *field.signal);
  });
}

}  // namespace

TypedChannels::TypedChannels(const BusPlan& plan, std::int64_t session)
    : units_{formats_of(plan)}, session_{session} {
  for (TypedMessage& message : typed_messages(plan)) {
    const std::uint64_t fingerprint = message.fingerprint();
    if (message.command) {
      std::string channel = message.channel;
      const std::uint64_t old = fingerprint_of_schema_1_of(message);
      commands_.emplace(std::move(channel), Type{std::move(message), fingerprint, old});
    } else {
      states_.push_back({std::move(message), fingerprint});
    }
  }
  std::size_t most = 0;
  for (const Type& state : states_) most = std::max(most, 8 + state.message.fields.size() * 8);
  buffer_.reserve(most);
}

std::vector<std::string> TypedChannels::heard(const BusPlan& plan) {
  std::vector<std::string> channels;
  for (const TypedMessage& message : typed_messages(plan)) {
    if (message.command) channels.push_back(message.channel);
  }
  return channels;
}

void TypedChannels::encode(const TypedField& field, std::int64_t raw) {
  const ValueFormat& format = units_.format(*field.signal);
  const auto si = [&] { return number_of(format.type, raw) * format.scale + format.offset; };
  switch (field.type) {
    case LcmPrimitive::boolean:
      return append_be(buffer_, static_cast<std::int8_t>(raw != 0));
    case LcmPrimitive::int8:
      return append_be(buffer_, static_cast<std::int8_t>(raw));
    case LcmPrimitive::int16:
      return append_be(buffer_, static_cast<std::int16_t>(raw));
    case LcmPrimitive::int32:
      return append_be(buffer_, static_cast<std::int32_t>(raw));
    case LcmPrimitive::int64:
    case LcmPrimitive::string:
      return append_be(buffer_, raw);
    case LcmPrimitive::float32:
      return append_be(buffer_, std::bit_cast<std::uint32_t>(static_cast<float>(si())));
    case LcmPrimitive::float64:
      return append_be(buffer_, std::bit_cast<std::uint64_t>(si()));
  }
}

void TypedChannels::encode(const Type& state, const ImageView& image, Time wall_minus_monotonic) {
  buffer_.clear();
  append_be(buffer_, state.fingerprint);
  append_be(buffer_, (image.sync_time + wall_minus_monotonic) / std::chrono::microseconds{1});
  append_be(buffer_, image.sync_time.count());
  append_be(buffer_, session_);
  append_be(buffer_, image.cycle);
  append_be(buffer_, static_cast<std::int8_t>(is_stale(image, state.message)));
  for (const TypedField& field : state.message.fields) {
    if (field.signal) encode(field, image.values[*field.signal]);
  }
}

void TypedChannels::publish(const ImageView& image, Time wall_minus_monotonic,
                            Transport& transport) {
  for (const Type& state : states_) {
    if (!transport.wanted(state.message.channel)) continue;
    encode(state, image, wall_minus_monotonic);
    transport.publish(state.message.channel, buffer_);
  }
}

std::optional<std::expected<command_t, DecodeFault>> TypedChannels::command(
    std::string_view channel, Bytes data) const {
  const auto found = commands_.find(channel);
  if (found == commands_.end()) return {};
  return decode(found->second, data);
}

std::optional<std::size_t> TypedChannels::node_of(std::string_view channel) const {
  const auto found = commands_.find(channel);
  if (found == commands_.end()) return {};
  return found->second.message.node_index;
}

std::expected<command_t, DecodeFault> TypedChannels::decode(const Type& type, Bytes data) const {
  Taker from{data};
  const auto fingerprint = from.take<std::uint64_t>();
  if (fingerprint != type.fingerprint) {
    if (data.size() < 8) return std::unexpected{DecodeFault::malformed};
    const bool old = fingerprint == type.fingerprint_of_schema_1;
    return std::unexpected{old ? DecodeFault::schema_1 : DecodeFault::other_version};
  }
  command_t command{};
  command.schema = message_schema;
  command.utime = from.take<std::int64_t>();
  command.session = from.take<std::int64_t>();
  command.instance = from.take<std::int64_t>();
  command.sender = from.text();
  command.cycle = from.take<std::int64_t>();
  command.time_to_live = from.take<std::int32_t>();
  command.release = from.take<std::int8_t>();
  for (const TypedField& field : type.message.fields) {
    if (!field.signal) continue;
    const Number number = take_number(from, field.type);
    if (number.real && std::isnan(*number.real)) continue;
    const auto raw =
        number.real ? units_.raw_of(*field.signal, *number.real) : std::optional{number.integer};
    if (!raw) return std::unexpected{DecodeFault::out_of_range};
    command.signals.push_back(static_cast<std::int32_t>(*field.signal));
    command.values.push_back(*raw);
  }
  command.num_values = static_cast<std::int32_t>(command.signals.size());
  if (!from.whole()) return std::unexpected{DecodeFault::malformed};
  return command;
}

}  // namespace takt
