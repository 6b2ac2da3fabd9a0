#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace takt::fuzz {

/// Ends the program if `holds` is false, so that libFuzzer keeps the input.
inline void demand(bool holds) {
  if (!holds) __builtin_trap();
}

/// The bytes of one input, taken from the front. After the last byte, all numbers are 0.
class Input {
 public:
  Input(const std::uint8_t* data, std::size_t size) : left_{data, size} {}

  bool empty() const noexcept { return left_.empty(); }
  std::size_t size() const noexcept { return left_.size(); }
  std::uint8_t byte() noexcept {
    if (left_.empty()) return 0;
    const std::uint8_t first = left_.front();
    left_ = left_.subspan(1);
    return first;
  }
  /// Takes a little-endian number of `width` bytes.
  std::uint64_t number(unsigned width) noexcept {
    std::uint64_t value = 0;
    for (unsigned i = 0; i < width; ++i) value |= std::uint64_t{byte()} << (8 * i);
    return value;
  }
  /// Takes the next `size` bytes, or as many as are left.
  std::span<const std::uint8_t> bytes(std::size_t size) noexcept {
    const auto some = left_.first(size < left_.size() ? size : left_.size());
    left_ = left_.subspan(some.size());
    return some;
  }
  std::string_view text(std::size_t size) noexcept {
    const auto some = bytes(size);
    return {reinterpret_cast<const char*>(some.data()), some.size()};
  }

 private:
  std::span<const std::uint8_t> left_;
};

}  // namespace takt::fuzz
