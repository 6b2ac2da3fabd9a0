#pragma once
#include <compare>
#include <cstdint>
#include <optional>
#include <string>

namespace takt {

/// Address of one device on the bus, 1..127. A NodeId is always valid. CiA 301, 7.3.3.
class NodeId {
 public:
  static constexpr std::optional<NodeId> from(unsigned value) noexcept {
    if (value < 1 || value > 127) return std::nullopt;
    return NodeId{static_cast<std::uint8_t>(value)};
  }
  constexpr std::uint8_t value() const noexcept { return value_; }
  constexpr auto operator<=>(const NodeId&) const noexcept = default;

  /// The literal `5_node`; a value outside 1..127 does not compile.
  friend consteval NodeId operator""_node(unsigned long long value);

 private:
  explicit constexpr NodeId(std::uint8_t value) noexcept : value_{value} {}
  std::uint8_t value_;
};

consteval NodeId operator""_node(unsigned long long value) {
  if (value < 1 || value > 127) throw "a node id is 1..127";
  return NodeId{static_cast<std::uint8_t>(value)};
}

/// A CAN identifier, 11 or 29 bits. CiA 301, 7.2.2.
class CobId {
 public:
  constexpr CobId() noexcept = default;
  /// Makes an 11-bit identifier; higher bits are cut.
  static constexpr CobId base(std::uint32_t id) noexcept { return CobId{id & 0x7FF}; }
  /// Makes a 29-bit identifier; higher bits are cut.
  static constexpr CobId extended(std::uint32_t id) noexcept {
    return CobId{(id & 0x1FFF'FFFF) | extended_flag};
  }
  /// Makes the identifier of an object such as 0x1800:01: bit 29 marks an identifier of 29 bits.
  static constexpr CobId of_object(std::uint32_t value) noexcept {
    return (value & 0x2000'0000) != 0 ? extended(value) : base(value);
  }
  constexpr std::uint32_t id() const noexcept { return raw_ & ~extended_flag; }
  constexpr bool is_extended() const noexcept { return (raw_ & extended_flag) != 0; }
  constexpr auto operator<=>(const CobId&) const noexcept = default;

 private:
  static constexpr std::uint32_t extended_flag = 0x8000'0000;
  explicit constexpr CobId(std::uint32_t raw) noexcept : raw_{raw} {}
  std::uint32_t raw_ = 0;
};

/// Bit 31 of an object with a COB-ID, such as 0x1014, 0x1200:01 or 0x1800:01: the service or the
/// PDO is off. CiA 301, 7.5.2.
inline constexpr std::uint32_t cob_id_off = 0x8000'0000;

/// Index and sub-index of an object. CiA 301, 7.4.
struct ObjectKey {
  std::uint16_t index = 0;
  std::uint8_t sub = 0;
  constexpr auto operator<=>(const ObjectKey&) const noexcept = default;
};

/// Number of axes that a device may have. CiA 402-1.
inline constexpr unsigned most_axes = 8;

/// Returns an object of an axis, which counts from 0, by its index on the first axis.
constexpr ObjectKey axis_object(unsigned axis, unsigned index, std::uint8_t sub = 0) noexcept {
  return {static_cast<std::uint16_t>(index + axis * 0x800), sub};
}

/// Returns the axis of an object of a device profile; empty for another object. CiA 402-1.
constexpr std::optional<unsigned> axis_of(ObjectKey object) noexcept {
  constexpr unsigned first = 0x6000;
  if (object.index < first || object.index >= first + most_axes * 0x800) return std::nullopt;
  return (object.index - first) / 0x800;
}

/// Formats a value as `0x6041`, with at least `digits` digits.
std::string hex(std::uint32_t value, int digits = 4);
/// Formats a value of up to 64 bits as hex() does.
std::string hex64(std::uint64_t value, int digits = 16);
/// Formats an object as `6041:00`.
std::string to_string(ObjectKey key);
/// Formats an identifier as `0x185`, or as `0x00012345` if it has 29 bits.
std::string to_string(CobId id);

}  // namespace takt
