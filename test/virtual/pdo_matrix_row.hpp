#pragma once
#include <cstdint>
#include <vector>

namespace takt::test {

/// The events for a TPDO; times are in ms after NMT start. E: changes, T: event timer, I: inhibit
/// time, R: remote requests, S: SYNC, P: the RPDO with the same number.
struct Course {
  std::uint16_t inhibit = 0;   ///< raw value of sub-index 3: 100 us, or ms for the DRV-28
  std::uint16_t timer = 0;     ///< ms
  std::vector<int> changes{};  ///< the value becomes a new one
  std::vector<int> back{};     ///< the first value returns
  std::vector<int> syncs{};
  std::vector<int> remote{};
  std::vector<int> rpdos{};
  bool no_rtr = false;  ///< bit 30 of the COB-ID
};

/// A TPDO of a device, and the times of the frames that must come within 200 ms.
struct TpdoRow {
  std::uint8_t type;
  const char* name;  ///< the events, and the reason for the frames
  Course course;
  std::vector<int> frames;
};

inline const std::vector<int> each_10{10, 20, 30, 40, 50};
inline const std::vector<int> each_10_on{10,  20,  30,  40,  50,  60,  70,  80,  90,  100,
                                         110, 120, 130, 140, 150, 160, 170, 180, 190, 200};

}  // namespace takt::test
