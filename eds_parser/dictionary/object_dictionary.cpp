#include "eds_parser/dictionary/object_dictionary.hpp"

#include <algorithm>
#include <bit>

#include "eds_parser/report/text.hpp"

namespace takt {
namespace {

std::vector<std::byte> bytes_of(std::string_view text) {
  std::vector<std::byte> bytes(text.size());
  std::ranges::transform(text, bytes.begin(), [](char c) { return static_cast<std::byte>(c); });
  return bytes;
}

std::uint64_t pattern_of(const Value& value, DataType type) noexcept {
  if (const auto* real = std::get_if<double>(&value)) {
    if (type == DataType::real32) return std::bit_cast<std::uint32_t>(static_cast<float>(*real));
    return std::bit_cast<std::uint64_t>(*real);
  }
  if (const auto* integer = std::get_if<std::int64_t>(&value)) {
    return std::bit_cast<std::uint64_t>(*integer);
  }
  return std::get<std::uint64_t>(value);
}

}  // namespace

const Object* ObjectDictionary::find(std::uint16_t index) const noexcept {
  const auto it = std::ranges::lower_bound(objects, index, {}, &Object::index);
  return it != objects.end() && it->index == index ? &*it : nullptr;
}

const SubObject* ObjectDictionary::find(ObjectKey key) const noexcept {
  const auto* object = find(key.index);
  if (object == nullptr) return nullptr;
  const auto it = std::ranges::lower_bound(object->subs, key.sub, {}, &SubObject::sub);
  return it != object->subs.end() && it->sub == key.sub ? &*it : nullptr;
}

std::optional<std::int64_t> as_integer(const Value& value) noexcept {
  if (const auto* integer = std::get_if<std::int64_t>(&value)) return *integer;
  if (const auto* number = std::get_if<std::uint64_t>(&value)) {
    return std::bit_cast<std::int64_t>(*number);
  }
  return std::nullopt;
}

bool outside_limits(const Value& value, const SubObject& sub) noexcept {
  const auto comparable = [&value](const std::optional<Value>& limit) {
    return limit && limit->index() == value.index() && !std::holds_alternative<BoxedText>(value);
  };
  if (comparable(sub.low_limit) && value < *sub.low_limit) return true;
  return comparable(sub.high_limit) && value > *sub.high_limit;
}

std::vector<std::byte> to_bytes(const Value& value, DataType type) {
  if (const auto* boxed = std::get_if<BoxedText>(&value)) {
    const auto& text = boxed->text();
    return type == DataType::unicode_string ? bytes_of(utf8_to_utf16le(text)) : bytes_of(text);
  }
  std::vector<std::byte> bytes(byte_width(type));
  std::uint64_t pattern = pattern_of(value, type);
  for (auto& byte : bytes) {
    byte = static_cast<std::byte>(pattern & 0xFF);
    pattern >>= 8;
  }
  return bytes;
}

std::string eds_value_text(const Value& value, DataType type) {
  if (const auto* number = std::get_if<std::int64_t>(&value)) return std::to_string(*number);
  if (const auto* number = std::get_if<std::uint64_t>(&value)) return std::to_string(*number);
  if (const auto* number = std::get_if<double>(&value)) return real_text(*number);
  const auto& bytes = std::get<BoxedText>(value).text();
  if (type == DataType::visible_string || type == DataType::unicode_string) return bytes;
  std::string digits;
  for (const char byte : bytes) digits += hex(static_cast<unsigned char>(byte), 2).substr(2);
  return digits;
}

}  // namespace takt
