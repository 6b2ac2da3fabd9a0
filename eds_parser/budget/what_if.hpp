#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "eds_parser/values/time.hpp"

namespace takt {

/// A hypothetical configuration of a PDO. Values that are not given stay unchanged.
struct PdoChange {
  std::string node;
  bool tpdo = true;
  std::uint16_t number = 1;
  std::optional<std::uint8_t> transmission{};
  std::optional<std::uint8_t> sync_start{};
  std::optional<std::uint16_t> inhibit_time{};  ///< multiples of 100 us
  std::optional<std::uint32_t> cob_id{};
  bool off = false;
};

/// Hypothetical values that replace those of a network file.
struct WhatIf {
  std::optional<std::uint32_t> sync_period_us{};
  std::optional<std::uint16_t> bitrate_kbit{};
  std::optional<std::uint16_t> service_frames{};
  std::optional<std::uint8_t> sync_overflow{};
  std::vector<PdoChange> pdos{};
};

inline constexpr std::uint32_t longest_period_us = 60'000'000;
inline constexpr std::uint16_t known_bitrates[] = {10, 20, 50, 100, 125, 250, 500, 800, 1000};

/// Adds `period=1ms`, `bitrate=500`, `services=2`, `counter=60`, `elbow.tpdo2=10` (transmission),
/// `elbow.tpdo2=off`, `elbow.tpdo2.start=2`, `.inhibit=10ms`, `.cob_id=0x1C0`. Returns false if the
/// text is none of these or if no network file may have this value.
bool add_change(std::string_view text, WhatIf& changes);

/// Values that are given in `more` replace those in `changes`.
void merge(WhatIf& changes, const WhatIf& more);

/// Returns the changes in the format of add_change(), separated by commas.
std::string to_string(const WhatIf& changes);

}  // namespace takt
