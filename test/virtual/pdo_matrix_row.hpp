#pragma once
#include <cstdint>
#include <vector>

namespace takt::test {

/// What happens to a TPDO, in ms after NMT start. E: changes, T: its event timer, I: its inhibit
/// time, R: remote requests, S: SYNC, P: the RPDO of its number.
struct Course {
  std::uint16_t inhibit = 0;   ///< sub 3 as it is written: 100 us, of the DRV-28 ms
  std::uint16_t timer = 0;     ///< ms
  std::vector<int> changes{};  ///< another value each time
  std::vector<int> back{};     ///< the first value again
  std::vector<int> syncs{};
  std::vector<int> remote{};
  std::vector<int> rpdos{};
  bool no_rtr = false;  ///< bit 30 of its COB-ID
};

/// A TPDO of a device, and the frames that must come within 200 ms.
struct TpdoRow {
  std::uint8_t type;
  const char* name;  ///< what happens, and why that follows
  Course course;
  std::vector<int> frames;
};

inline const std::vector<int> each_10{10, 20, 30, 40, 50};
inline const std::vector<int> each_10_on{10,  20,  30,  40,  50,  60,  70,  80,  90,  100,
                                         110, 120, 130, 140, 150, 160, 170, 180, 190, 200};

}  // namespace takt::test
