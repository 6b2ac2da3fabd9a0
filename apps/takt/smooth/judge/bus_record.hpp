#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "eds_parser/values/ids.hpp"
#include "eds_parser/values/time.hpp"

namespace takt::smooth {

/// A value and the time of the frame that carried it.
struct Sample {
  Time when{};
  std::int64_t value = 0;
};

/// The settings of a drive that concern its set-points. A value is empty if it is not known.
struct AxisSettings {
  std::optional<unsigned> transmission{};  ///< type of the RPDO with the set-point, 0..255
  std::optional<Time> interpolation{};     ///< 0x60C2
  bool interpolation_refused = false;      ///< the drive has refused a write to 0x60C2
  bool boot_seen = false;     ///< all writes of the boot are known, also those that are missing
  std::optional<int> mode{};  ///< 0x6060, if it is written by SDO
  bool feed_forward = false;  ///< 0x60B1 or 0x60B2 is mapped into an RPDO
};

/// The signals of one axis of a drive in a recording. All samples are in the order of time.
struct AxisRecord {
  std::string name{};
  std::uint8_t node = 0;
  unsigned axis = 0;         ///< counts from 0
  ObjectKey set_point{};     ///< object of the set-point: 607A, 60C1:01 or 60FF of the axis
  CobId set_point_id{};      ///< RPDO that carries the set-point
  bool by_velocity = false;  ///< the set-point is a velocity
  AxisSettings settings{};
  std::vector<Sample> set_points{};
  std::vector<Sample> positions{};     ///< 6064
  std::vector<Sample> velocities{};    ///< 606C
  std::vector<Sample> statuswords{};   ///< 6041
  std::vector<Sample> controlwords{};  ///< 6040
  std::vector<Sample> asked_modes{};   ///< 6060 in an RPDO
  std::vector<Sample> modes{};         ///< 6061
};

/// A frame as a load of the bus.
struct WireFrame {
  Time when{};             ///< end of the frame
  std::uint16_t bits = 0;  ///< length of the frame on the wire with average bit stuffing
};

/// The data of a recording from which the smoothness of the axes is judged. Times count from the
/// beginning of the recording and always increase, also if several frames have one time stamp.
struct BusRecord {
  std::string source{};  ///< path of the file, or the interface or bus that was recorded
  Time length{};
  Time resolution{};       ///< resolution of the time stamps
  bool with_times = true;  ///< false: the times of the set-points within their cycles are not known
  std::optional<Time> planned_period{};  ///< period of SYNC by the network file or 0x1006
  std::uint32_t bitrate = 0;             ///< bit/s; 0 = not known
  std::vector<Time> syncs{};
  std::vector<WireFrame> frames{};
  std::vector<AxisRecord> axes{};
  std::vector<std::string> remarks{};  ///< sentences on what the recording does not show
};

}  // namespace takt::smooth
