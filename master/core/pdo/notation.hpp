#pragma once
#include <bit>
#include <cstdint>

#include "eds_parser/table/image_layout.hpp"

namespace takt {

/// Converts the raw values of a signal to numbers. The bits of a raw value above the width of the
/// object are ignored, because a frame does not carry them.
class Notation {
 public:
  explicit Notation(const Signal& signal) noexcept {
    if (signal.type == DataType::real32) {
      kind_ = Kind::real32;
    } else if (signal.type == DataType::real64) {
      kind_ = Kind::real64;
    } else {
      kind_ = is_signed(signal.type) ? Kind::with_sign : Kind::without_sign;
      const int spare = signal.bits == 0 || signal.bits > 64 ? 0 : 64 - signal.bits;
      spare_ = static_cast<std::uint8_t>(spare);
    }
  }

  double number(std::int64_t raw) const noexcept {
    const auto top = static_cast<std::uint64_t>(raw) << spare_;
    switch (kind_) {
      case Kind::with_sign:
        return static_cast<double>(static_cast<std::int64_t>(top) >> spare_);
      case Kind::without_sign:
        return static_cast<double>(top >> spare_);
      case Kind::real32:
        return double{std::bit_cast<float>(static_cast<std::uint32_t>(raw))};
      case Kind::real64:
        break;
    }
    return std::bit_cast<double>(raw);
  }

 private:
  enum class Kind : std::uint8_t { with_sign, without_sign, real32, real64 };

  Kind kind_ = Kind::with_sign;
  std::uint8_t spare_ = 0;  ///< unused bits above the value
};

}  // namespace takt
