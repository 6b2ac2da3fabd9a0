#include "apps/takt/spy/message_values.hpp"

#include <bit>
#include <charconv>
#include <fmt/format.h>
#include <map>
#include <optional>
#include <type_traits>
#include <utility>

#include "master/lcm/big_endian.hpp"
#include "master/lcm/printable_text.hpp"

namespace takt::spy {
namespace {

constexpr std::size_t most_values = 20'000;
constexpr std::size_t most_numbers = 16;  // largest number of elements of an array that are shown
constexpr int most_depth = 8;             // deepest nesting of types

struct Broken {
  std::string sentence;
};

class Decoder {
 public:
  Decoder(const MessageTypes& types, Bytes bytes) : types_{types}, rest_{bytes} {}

  void decode_struct(std::string_view type, const std::string& prefix, int depth) {
    const auto found = types_.find(type);
    if (found == types_.end() || depth > most_depth) {
      throw Broken{fmt::format("takt does not know the type {}", type)};
    }
    std::map<std::string_view, std::int64_t> sizes;
    for (const Member& member : found->second) {
      const std::size_t values_before = values_.size();
      decode_member(member, prefix + member.name, sizes, depth);
      if (member.dimensions.empty() && values_.size() == values_before + 1) {
        if (last_integer_) sizes[member.name] = *last_integer_;
      }
    }
  }

  bool at_end() const { return rest_.empty(); }
  std::vector<Value> take() { return std::move(values_); }

 private:
  void decode_member(const Member& member, const std::string& name,
                     const std::map<std::string_view, std::int64_t>& sizes, int depth) {
    last_integer_.reset();
    if (member.dimensions.empty()) return decode_one(member, name, depth);
    std::int64_t count = 1;
    for (const std::string& dimension : member.dimensions) {
      const auto left = static_cast<std::int64_t>(rest_.size());
      const std::int64_t size = size_of(dimension, sizes);
      // An element has at least one byte, so more elements can't be in the message.
      if (size < 0 || size > left || count * size > left) {
        throw Broken{
            fmt::format("{} has {} elements, but {} bytes are left", name, size, rest_.size())};
      }
      count *= size;
    }
    if (types_.contains(member.type)) {
      for (std::int64_t i = 0; i < count; ++i) {
        decode_struct(member.type, fmt::format("{}[{}].", name, i), depth + 1);
      }
      return;
    }
    std::string text = "[";
    for (std::int64_t i = 0; i < count; ++i) {
      const std::string one = primitive(member.type, name);
      if (i < static_cast<std::int64_t>(most_numbers)) text += (i == 0 ? "" : ", ") + one;
    }
    if (count > static_cast<std::int64_t>(most_numbers)) {
      text += fmt::format(", ... {} in all", count);
    }
    last_integer_.reset();
    add(name, text + "]", member);
  }

  void decode_one(const Member& member, const std::string& name, int depth) {
    if (types_.contains(member.type)) return decode_struct(member.type, name + '.', depth + 1);
    add(name, primitive(member.type, name), member);
  }

  void add(const std::string& name, std::string text, const Member& member) {
    if (values_.size() == most_values) throw Broken{"the message has too many values"};
    values_.push_back({name, std::move(text), member.comment});
  }

  static std::int64_t size_of(const std::string& dimension,
                              const std::map<std::string_view, std::int64_t>& sizes) {
    std::int64_t number = 0;
    const char* const end = dimension.data() + dimension.size();
    if (std::from_chars(dimension.data(), end, number).ptr == end) return number;
    const auto found = sizes.find(dimension);
    return found == sizes.end() ? -1 : found->second;
  }

  template <class Number>
  Number number(const std::string& name) {
    if (rest_.size() < sizeof(Number)) throw Broken{"the message ends at " + name};
    const Number value = load_be<Number>(rest_);
    rest_ = rest_.subspan(sizeof(Number));
    return value;
  }

  template <class Integer>
  std::string integer(const std::string& name) {
    last_integer_ = static_cast<Integer>(number<std::make_unsigned_t<Integer>>(name));
    return std::to_string(*last_integer_);
  }

  std::string primitive(const std::string& type, const std::string& name) {
    if (type == "int64_t") return integer<std::int64_t>(name);
    if (type == "int32_t") return integer<std::int32_t>(name);
    if (type == "int16_t") return integer<std::int16_t>(name);
    if (type == "int8_t") return integer<std::int8_t>(name);
    if (type == "byte") return fmt::format("{:02X}", number<std::uint8_t>(name));
    if (type == "boolean") return number<std::uint8_t>(name) != 0 ? "true" : "false";
    if (type == "double") {
      return fmt::format("{:.12g}", std::bit_cast<double>(number<std::uint64_t>(name)));
    }
    if (type == "float") {
      return fmt::format("{:.7g}", std::bit_cast<float>(number<std::uint32_t>(name)));
    }
    if (type == "string") return text(name);
    throw Broken{fmt::format("takt does not know the type {}", type)};
  }

  /// The length in the message includes the terminating zero.
  std::string text(const std::string& name) {
    const std::size_t length = number<std::uint32_t>(name);
    if (length == 0 || length > rest_.size()) throw Broken{"the message ends at " + name};
    const auto* const first = reinterpret_cast<const char*>(rest_.data());
    const std::string shown = printable_text({first, length - 1});
    rest_ = rest_.subspan(length);
    return '"' + shown + '"';
  }

  const MessageTypes& types_;
  Bytes rest_;
  std::vector<Value> values_;
  std::optional<std::int64_t> last_integer_;  // the newest value, if it is an integer
};

}  // namespace

std::expected<std::vector<Value>, std::string> decode_values(const MessageTypes& types,
                                                             std::string_view type, Bytes bytes) {
  if (bytes.size() < 8) return std::unexpected{"the message has less than the 8 bytes of a type"};
  Decoder decoder{types, bytes.subspan(8)};
  try {
    decoder.decode_struct(type, "", 0);
  } catch (const Broken& broken) {
    return std::unexpected{broken.sentence};
  }
  if (!decoder.at_end()) return std::unexpected{"the message is longer than its type"};
  return decoder.take();
}

}  // namespace takt::spy
