#pragma once
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "eds_parser/table/ids.hpp"
#include "eds_parser/table/pdo_table.hpp"

namespace takt {

/// What a limit bounds.
enum class LimitKind : std::uint8_t {
  position,
  velocity,
  acceleration,
  jerk,  ///< not checked: set-points of whole counts can't show it
  step,
  torque,
  range,  ///< of a single output
};

/// Where a limit comes from.
enum class LimitSource : std::uint8_t {
  none,    ///< there is no limit
  file,    ///< `limits:` of the network file
  device,  ///< the device tells it in each boot
};

/// One limit as people see it: what `takt plan` prints. Values in `unit`.
struct LimitLine {
  std::uint8_t node_index = 0;  ///< position in BusPlan::nodes
  std::uint8_t axis = 0;        ///< 1..8; 0: of the single output `object`
  ObjectKey object{};           ///< the single output; `source` device: what is read in a boot
  LimitKind kind = LimitKind::range;
  LimitSource source = LimitSource::none;
  std::optional<double> low{};   ///< position and range only
  std::optional<double> high{};  ///< upper limit, or greatest magnitude
  std::string unit{};
  double scale = 1.0;                  ///< `source` device: value of the object x scale + offset,
  double offset = 0.0;                 ///< in `unit`
  std::vector<SignalIndex> signals{};  ///< the outputs that are checked; none: nothing is
  std::string proposal{};              ///< `velocity: 2.5`; where there is no limit
  std::string because{};               ///< where the proposal comes from
};

/// What the bus thread checks of one output, in raw counts. Rates count per cycle: the bus thread
/// multiplies them with the cycles that have passed.
struct OutputLimit {
  static constexpr double none = std::numeric_limits<double>::infinity();

  SignalIndex signal = 0;
  double low = -none;
  double high = none;
  LimitKind range = LimitKind::range;  ///< what `low` and `high` bound
  double step = none;                  ///< greatest difference in one cycle
  double rate = none;                  ///< the same, from a velocity or an acceleration
  LimitKind rate_of = LimitKind::velocity;
  double bend = none;    ///< greatest change of the difference: an acceleration, per cycle squared
  double modulus = 0.0;  ///< differences count modulo this; 0: they don't
  bool wraps = false;    ///< differences count modulo the width of the object
  std::optional<SignalIndex> feedback{};      ///< 6064: a set-point may begin there
  std::optional<SignalIndex> statusword{};    ///< tells whether the drive follows set-points
  std::optional<SignalIndex> mode{};          ///< 6060, where it is an output
  std::optional<SignalIndex> mode_display{};  ///< 6061
  bool profile = false;  ///< 6060 is no output, and the file sets profile position mode
};

/// What a value that is read from a device becomes.
enum class DeviceBound : std::uint8_t {
  range,  ///< OutputLimit::low, and OutputLimit::high from the next sub-index; INTEGER32
  size,   ///< both, as a magnitude; UNSIGNED32
  rate,   ///< OutputLimit::rate; UNSIGNED32
  bend,   ///< OutputLimit::bend; UNSIGNED32
};

/// A limit that a device tells in each boot. It holds where it is plausible, see limit_names.hpp.
struct DeviceLimit {
  std::uint8_t node_index = 0;
  ObjectKey object{};
  SignalIndex signal = 0;
  DeviceBound bound = DeviceBound::size;
  double factor = 1.0;     ///< value of the device x factor = the bound in counts of the signal
  std::uint16_t line = 0;  ///< place in LimitsPlan::lines
};

/// Where the upper end of a range is.
constexpr ObjectKey upper_object(const DeviceLimit& limit) noexcept {
  return {limit.object.index, static_cast<std::uint8_t>(limit.object.sub + 1)};
}

/// A limit as a boot has read it.
struct LimitReading {
  ObjectKey object{};
  std::uint32_t value = 0;
};

/// All limits of a bus.
struct LimitsPlan {
  std::vector<OutputLimit> outputs{};  ///< ascending signals
  std::vector<DeviceLimit> device{};   ///< by node
  std::vector<LimitLine> lines{};      ///< by node, axis and kind
};

}  // namespace takt
