#pragma once
#include <chrono>
#include <cstdint>
#include <optional>

#include "eds_parser/values/time.hpp"
#include "master/wire/bytes.hpp"
#include "master/wire/frame.hpp"

namespace takt {

/// Value of the type TIME_OF_DAY: days since 1984-01-01 and milliseconds since midnight. CiA
/// 301, 7.1.6.6. takt sends UTC, because the standard does not name a time zone.
struct TimeOfDay {
  std::uint16_t days = 0;
  std::uint32_t ms = 0;  ///< 0..86,399,999

  friend constexpr bool operator==(const TimeOfDay&, const TimeOfDay&) = default;
};

namespace time_detail {
constexpr std::int64_t ms_a_day = 86'400'000;
constexpr std::int64_t first_day = 5113;  ///< 1984-01-01, in days since 1970-01-01
}  // namespace time_detail

/// Converts a time since 1970-01-01 UTC. Returns std::nullopt before 1984 and after day 65535
/// (2163-06-06).
constexpr std::optional<TimeOfDay> time_of_day(Time unix_time) noexcept {
  using namespace time_detail;
  const std::int64_t ms = std::chrono::floor<std::chrono::milliseconds>(unix_time).count();
  const std::int64_t days = ms / ms_a_day - first_day;
  if (ms < 0 || days < 0 || days > 0xFFFF) return std::nullopt;
  return TimeOfDay{.days = static_cast<std::uint16_t>(days),
                   .ms = static_cast<std::uint32_t>(ms % ms_a_day)};
}

/// Converts to a time since 1970-01-01 UTC.
constexpr Time unix_time(TimeOfDay time) noexcept {
  using namespace time_detail;
  return std::chrono::milliseconds{(time.days + first_day) * ms_a_day + time.ms};
}

/// Makes a TIME message.
constexpr Frame time_frame(CobId id, TimeOfDay time) noexcept {
  Frame frame{.id = id, .length = 6};
  store_le(std::span{frame.data}, time.ms);
  store_le(std::span{frame.data}.subspan(4), time.days);
  return frame;
}

/// Decodes a TIME message. Returns std::nullopt if the frame has fewer than six bytes. Bits 28 to
/// 31 are reserved and are ignored.
constexpr std::optional<TimeOfDay> decode_time(const Frame& frame) noexcept {
  if (frame.length < 6) return std::nullopt;
  return TimeOfDay{.days = load_le<std::uint16_t>(std::span{frame.data}.subspan(4)),
                   .ms = load_le<std::uint32_t>(std::span{frame.data}) & 0x0FFF'FFFF};
}

}  // namespace takt
