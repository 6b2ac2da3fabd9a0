#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "eds_parser/table/time.hpp"

namespace takt {

/// A PDO that were configured otherwise. What is not given stays.
struct PdoChange {
  std::string node;
  bool tpdo = true;
  std::uint16_t number = 1;
  std::optional<std::uint8_t> transmission{};
  std::optional<std::uint8_t> sync_start{};
  std::optional<std::uint16_t> inhibit_time{};  ///< 100 us
  std::optional<std::uint32_t> cob_id{};
  bool off = false;
};

/// Values that stand in for those of a network file: what would be if.
struct WhatIf {
  std::optional<std::uint32_t> sync_period_us{};
  std::optional<std::uint16_t> bitrate_kbit{};
  std::optional<std::uint16_t> service_frames{};
  std::optional<std::uint8_t> sync_overflow{};
  std::vector<PdoChange> pdos{};
};

inline constexpr std::uint16_t known_bitrates[] = {10, 20, 50, 100, 125, 250, 500, 800, 1000};

/// Adds `period=1ms`, `bitrate=500`, `services=2`, `counter=60`, `elbow.tpdo2=10` (transmission),
/// `elbow.tpdo2=off`, `elbow.tpdo2.start=2`, `.inhibit=10ms`, `.cob_id=0x1C0`. False: it is none
/// of these, or a value that no network file may have.
bool add_change(std::string_view text, WhatIf& changes);

/// What is given in `more` takes the place of what is there.
void merge(WhatIf& changes, const WhatIf& more);

/// The same as add_change() takes, with a comma between two.
std::string to_string(const WhatIf& changes);

}  // namespace takt
