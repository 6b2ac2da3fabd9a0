#include "master/lcm/message_shape.hpp"

#include <cstdint>
#include <optional>

#include "master/lcm/big_endian.hpp"

namespace takt {
namespace {

class ShapeWalk {
 public:
  explicit ShapeWalk(std::span<const std::byte> body) noexcept : rest_{body} {}

  bool walk(std::string_view shape) noexcept {
    std::uint32_t count = 0;
    for (std::size_t at = 0; at < shape.size(); ++at) {
      if (shape[at] == '(') {
        const std::size_t end = closing(shape, at);
        if (!repeat(shape.substr(at + 1, end - at - 1), count)) return false;
        at = end;
      } else if (shape[at] == 'n') {
        const auto length = take_length();
        if (!length) return false;
        count = *length;
      } else if (!take_one(shape[at])) {
        return false;
      }
    }
    return true;
  }

  bool at_end() const noexcept { return rest_.empty(); }

 private:
  static std::size_t closing(std::string_view shape, std::size_t open) noexcept {
    int depth = 0;
    for (std::size_t at = open; at < shape.size(); ++at) {
      if (shape[at] == '(') ++depth;
      if (shape[at] == ')' && --depth == 0) return at;
    }
    return shape.size();
  }

  static std::size_t fixed_size(char kind) noexcept {
    if (kind == 'b') return 1;
    if (kind == 'h') return 2;
    return kind == 'i' || kind == 'f' ? 4 : 8;
  }

  /// Returns the size of a part that consists of numbers only.
  static std::optional<std::size_t> size_of(std::string_view shape) noexcept {
    if (shape.find_first_of("sn(") != std::string_view::npos) return std::nullopt;
    std::size_t size = 0;
    for (const char kind : shape) size += fixed_size(kind);
    return size;
  }

  // Checks a part `count` times. Each time takes at least one byte, so a huge count ends at the end
  // of the message.
  bool repeat(std::string_view shape, std::uint32_t count) noexcept {
    if (const auto size = size_of(shape)) return take(*size * count);
    for (std::uint32_t i = 0; i < count; ++i) {
      if (!walk(shape)) return false;
    }
    return true;
  }

  bool take_one(char kind) noexcept {
    if (kind == 's') {
      const auto length = take_length();
      return length && *length > 0 && take(*length);
    }
    return take(fixed_size(kind));
  }

  std::optional<std::uint32_t> take_length() noexcept {
    if (rest_.size() < 4) return std::nullopt;
    const auto value = load_be<std::uint32_t>(rest_);
    rest_ = rest_.subspan(4);
    if (value > 0x7FFF'FFFF) return std::nullopt;
    return value;
  }

  bool take(std::size_t size) noexcept {
    if (size > rest_.size()) return false;
    rest_ = rest_.subspan(size);
    return true;
  }

  std::span<const std::byte> rest_;
};

}  // namespace

bool has_shape(std::span<const std::byte> body, std::string_view shape) noexcept {
  ShapeWalk walk{body};
  return walk.walk(shape) && walk.at_end();
}

}  // namespace takt
