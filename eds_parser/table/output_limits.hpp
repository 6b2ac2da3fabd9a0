#pragma once
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "eds_parser/table/pdo_table.hpp"
#include "eds_parser/table/speed_axis.hpp"
#include "eds_parser/values/ids.hpp"

namespace takt {

/// The quantity that a limit bounds.
enum class LimitKind : std::uint8_t {
  position,
  velocity,
  acceleration,
  jerk,  ///< not checked, because the jerk can't be computed from set-points in whole counts
  step,
  torque,
  range,            ///< range of a single output
  following_error,  ///< following error of a motion: the bus thread stops a motion that exceeds it,
                    ///< and checks no output
};

/// The kind of a set-point of an axis. It decides in which modes the axis follows the set-point.
enum class AxisQuantity : std::uint8_t { none, position, velocity, torque };

/// The source of a limit.
enum class LimitSource : std::uint8_t {
  none,    ///< no limit is known
  file,    ///< `limits:` of the network file
  device,  ///< the master reads it from the device in each boot
};

/// One limit in the form that `takt plan` prints. Values are in `unit`.
struct LimitLine {
  std::uint8_t node_index = 0;  ///< position in BusPlan::nodes
  std::uint8_t axis = 0;        ///< 1..8; 0 = the limit of the single output `object`
  ObjectKey object{};           ///< single output; with `source` device the object read in a boot
  LimitKind kind = LimitKind::range;
  LimitSource source = LimitSource::none;
  std::optional<double> low{};   ///< position and range only
  std::optional<double> high{};  ///< upper limit or greatest magnitude
  std::string unit{};
  double scale = 1.0;   ///< `source` device: limit = value of the object x scale + offset,
  double offset = 0.0;  ///< offset in `unit`
  std::vector<SignalIndex> signals{};  ///< outputs that are checked; empty = no check
  std::string proposal{};              ///< `velocity: 2.5`; only if there is no limit
  std::string because{};               ///< reason for the proposal
};

/// The limits of one output that the bus thread checks, in raw counts. Rates are per cycle: the bus
/// thread multiplies them by the number of cycles that have passed. A drive adds an offset (60B0,
/// 60B1, 60B2) to a target (607A or 60C1, 60FF, 6071), so the limits of the target hold for the sum
/// of both.
struct OutputLimit {
  static constexpr double none = std::numeric_limits<double>::infinity();

  SignalIndex signal = 0;
  double low = -none;
  double high = none;
  LimitKind range = LimitKind::range;  ///< quantity that `low` and `high` bound
  double step = none;                  ///< greatest difference in one cycle
  double rate = none;  ///< limit of the same difference, derived from a velocity or an acceleration
  LimitKind rate_of = LimitKind::velocity;
  double bend = none;    ///< greatest change of the difference (acceleration), per cycle squared
  double modulus = 0.0;  ///< differences are taken modulo this value; 0 = no modulo
  double lowest = 0.0;   ///< the position at which a range of `modulus` counts begins
  bool wraps = false;    ///< differences are taken modulo the range of values of the object
  AxisQuantity quantity = AxisQuantity::none;
  /// For a target: the output that the drive adds to the target.
  std::optional<SignalIndex> offset{};
  std::optional<SignalIndex> target{};  ///< for an offset: the output to which the offset is added
  std::optional<SignalIndex> controlword{};  ///< 6040 of the axis, for a position
  /// 6064 of a position, 606C of a target velocity: value from which the first set-point may start.
  std::optional<SignalIndex> feedback{};
  std::optional<SignalIndex> statusword{};    ///< shows whether the drive follows set-points
  std::optional<SignalIndex> mode{};          ///< 6060, if it is an output
  std::optional<SignalIndex> mode_display{};  ///< 6061
  /// For a set speed: effect of `controlword` on the set speed.
  std::optional<SpeedOrders> orders{};
  std::optional<std::int64_t> fixed_mode{};  ///< mode that the file sets, if 6060 is no output
};

/// The field of OutputLimit that a value read from a device sets.
enum class DeviceBound : std::uint8_t {
  range,  ///< sets `low` from this object and `high` from the next sub-index; INTEGER32
  size,   ///< sets `low` and `high` to -value and +value; UNSIGNED32
  rate,   ///< OutputLimit::rate; UNSIGNED32
  bend,   ///< OutputLimit::bend; UNSIGNED32
};

/// A limit that the master reads from a device in each boot. The master uses it only if it is
/// plausible, see plausible_range() and plausible_size().
struct DeviceLimit {
  std::uint8_t node_index = 0;
  ObjectKey object{};
  SignalIndex signal = 0;
  DeviceBound bound = DeviceBound::size;
  double factor = 1.0;     ///< bound in counts of the signal = value of the device x factor
  std::uint16_t line = 0;  ///< position in LimitsPlan::lines
};

/// Returns the object that holds the upper end of a range.
constexpr ObjectKey upper_object(const DeviceLimit& limit) noexcept {
  return {limit.object.index, static_cast<std::uint8_t>(limit.object.sub + 1)};
}

/// The value of a limit, or of a quick stop option code, that a boot has read.
struct LimitReading {
  ObjectKey object{};
  std::uint32_t value = 0;  ///< the value; that of an object of 16 bits is in the lower half
};

/// All limits of a bus.
struct LimitsPlan {
  std::vector<OutputLimit> outputs{};  ///< in ascending order of their signals
  std::vector<DeviceLimit> device{};   ///< sorted by node
  std::vector<LimitLine> lines{};      ///< sorted by node, axis and kind
};

/// A target and the offset that a drive adds to it.
struct LimitSum {
  SignalIndex target = 0;
  SignalIndex offset = 0;
};

/// Returns the sums that a limit holds for.
std::vector<LimitSum> sums_of(const LimitsPlan& limits, const LimitLine& line);

/// Returns the key of the limit in `limits:` of the network file.
std::string_view name(LimitKind kind) noexcept;
/// Returns `file`, `device` or `none`.
std::string_view name(LimitSource source) noexcept;

/// Returns true if this end of a range bounds nothing, because it is the end of INTEGER32.
constexpr bool open_end(std::int64_t end) noexcept {
  return end <= -0x7FFF'FFFFLL || end >= 0x7FFF'FFFFLL;
}

/// Returns true if the range that a device reports is a real limit: the range is not empty and does
/// not cover the whole of an INTEGER16 or INTEGER32. One end may be open.
constexpr bool plausible_range(std::int64_t low, std::int64_t high) noexcept {
  const bool whole16 = low <= -0x7FFF && high == 0x7FFF;
  return low < high && !whole16 && !(open_end(low) && open_end(high));
}

/// Returns true if a reported magnitude is a real limit: it is neither 0 nor the highest value of a
/// type (0xFFFF, or 0x7FFF'FFFF and above).
constexpr bool plausible_size(std::int64_t value) noexcept {
  return value > 0 && value != 0xFFFF && value < 0x7FFF'FFFF;
}

}  // namespace takt
