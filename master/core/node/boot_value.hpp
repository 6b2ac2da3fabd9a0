#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "eds_parser/table/boot_plan.hpp"
#include "eds_parser/table/firmware.hpp"
#include "master/wire/bytes.hpp"
#include "master/wire/sdo_abort.hpp"

namespace takt {

/// Returns true if all bytes are zero.
inline bool all_zero(std::span<const std::byte> value) noexcept {
  return std::ranges::all_of(value, [](std::byte byte) { return byte == std::byte{0}; });
}

/// Compares the value of the device (`got`) with the expected one (`want`). Numbers are compared by
/// their low bytes under `mask`, because some devices answer with more or fewer bytes than the EDS
/// says. Strings and other long values are compared without trailing zeros.
inline bool same_value(std::span<const std::byte> got, std::span<const std::byte> want,
                       std::uint32_t mask) noexcept {
  if (want.size() <= 4) {
    const auto width = std::min<std::size_t>(want.size(), got.size());
    const auto low = [width](std::span<const std::byte> bytes) {
      return load_le<std::uint32_t>(bytes.first(std::min(width, bytes.size())));
    };
    return (low(got) & mask) == (low(want) & mask) && all_zero(want.subspan(width));
  }
  const auto common = std::min(want.size(), got.size());
  return std::ranges::equal(want.first(common), got.first(common)) &&
         all_zero(want.subspan(common)) && all_zero(got.subspan(common));
}

/// Returns true if the abort code means that the object is absent and the step permits this. In
/// optional steps that expect zero, an absent object counts as zero.
inline bool may_be_missing(const BootStep& step, std::uint32_t code) noexcept {
  return step.optional && all_zero(step.value) &&
         (code == abort_code::no_object || code == abort_code::no_sub_index);
}

/// Returns true for abort codes with which devices refuse to write a value that the object already
/// has. The object is then read back.
inline bool may_be_redundant(const BootStep& step, std::uint32_t code) noexcept {
  return step.optional && (code == abort_code::access_unsupported ||
                           code == abort_code::read_only || code == abort_code::no_sub_index ||
                           code == abort_code::invalid_value || code == abort_code::device_state);
}

/// Returns true if the abort code means that the device is alive but not ready yet. While it boots,
/// the request is repeated.
inline bool means_busy(std::uint32_t code) noexcept {
  return code >> 16 == 0x0503 || code >> 16 == 0x0504 || code == abort_code::resource_unavailable ||
         code == abort_code::cannot_store || code == abort_code::local_control ||
         code == abort_code::device_state;
}

/// Returns the firmware version that the value of an object states. The revision number in 0x1018
/// is a number; all other objects hold a text.
inline std::optional<Firmware> firmware_in(ObjectKey object,
                                           std::span<const std::byte> value) noexcept {
  if (object.index == 0x1018) return Firmware::of_revision(load_le<std::uint32_t>(value));
  std::array<char, 64> text{};
  const std::size_t size = std::min(value.size(), text.size());
  for (std::size_t i = 0; i < size; ++i) text[i] = std::to_integer<char>(value[i]);
  return Firmware::find_in({text.data(), size});
}

}  // namespace takt
