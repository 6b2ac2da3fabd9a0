#pragma once
#include <cstdint>
#include <optional>

#include "eds_parser/values/ids.hpp"
#include "eds_parser/values/pdo_number.hpp"

namespace takt {

/// The COB-ID object that a boot has read or written last, with its value. The identifier of a PDO
/// may change only while bit 31 is set, which means that the PDO does not exist. Bit 30 keeps the
/// value that it has in the device. CiA 301, 7.5.2.35 and 7.5.2.37.
class CobIdMemory {
 public:
  /// Notes the value of an object if it is the COB-ID of a PDO or of EMCY (0x1014).
  void note(ObjectKey object, std::uint32_t value) noexcept {
    if (!is_cob_id(object)) return;
    object_ = object;
    value_ = value;
  }
  void forget() noexcept { object_.reset(); }
  bool knows(ObjectKey object) const noexcept { return object_ == object; }

  std::uint32_t value() const noexcept { return value_; }
  /// Returns the known value with bit 31 set, which switches the PDO off.
  std::uint32_t disabled() const noexcept { return value_ | pdo_invalid; }
  /// Returns the `wanted` COB-ID with the bit 30 of the known value.
  std::uint32_t enabled(std::uint32_t wanted) const noexcept {
    return (wanted & ~no_rtr) | (value_ & no_rtr);
  }

 private:
  static constexpr std::uint32_t pdo_invalid = 0x8000'0000;  // bit 31
  static constexpr std::uint32_t no_rtr = 0x4000'0000;       // bit 30: no RTR allowed

  static bool is_cob_id(ObjectKey object) noexcept {
    return object == ObjectKey{0x1014, 0} || is_pdo_cob_id(object);
  }

  std::optional<ObjectKey> object_;
  std::uint32_t value_ = 0;
};

}  // namespace takt
