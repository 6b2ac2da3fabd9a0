#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "apps/takt/simulate/motion/motion_script.hpp"
#include "eds_parser/table/pdo_table.hpp"
#include "eds_parser/values/time.hpp"

namespace takt {

/// The words that report the speed of a speed axis.
struct SpeedWord {
  SignalIndex signal = 0;  ///< actual speed, or the set speed if no TPDO has the actual one
  double scale = 1.0;      ///< speed = raw value x scale
};

/// The largest magnitudes that taktd has reported for an axis while an entry was in progress, in
/// the unit of the axis and in seconds. `velocity` is the commanded velocity. For a speed axis, it
/// is the speed that `speed_word` reports, and the other two magnitudes are 0.
struct AxisMaxima {
  std::string axis;
  std::string unit;  ///< unit of positions; of speeds for a speed axis; empty for raw counts
  std::int16_t node_id = 0;  ///< node-ID as in axis_motion_t
  std::int8_t number = 0;    ///< number of the axis in its device, from 1, as in axis_motion_t
  std::optional<SpeedWord> speed_word{};  ///< empty unless the axis is a speed axis
  double following_error = 0.0;           ///< commanded minus actual position
  double velocity = 0.0;
  double acceleration = 0.0;  ///< commanded
};

/// The outcome of an entry of `motions:`.
struct MotionOutcome {
  std::string program;
  MotionKind kind = MotionKind::enable;
  SourcePos pos{};
  std::optional<Time> begin{};  ///< time at which the program began the entry; empty: never
  std::optional<Time> end{};  ///< time at which the program knew the end of the entry; empty: never
  /// `done`, `running`, `not_begun`, or the reason of another end.
  std::string result = "not_begun";
  std::string text{};  ///< sentence about an end other than `done`
  std::vector<AxisMaxima> axes{};
  std::string expect = "done";  ///< one of expectable_ends
  /// True if the script has ended the entry: its next entry, `kill`, or the end of the run.
  bool by_script = false;

  bool as_expected() const { return by_script ? expect == "ended" : expect == result; }
};

/// Returns the number of entries that did not end as expected.
std::size_t unexpected_ends(const std::vector<MotionOutcome>& outcomes);

/// Returns the number of axes that have moved.
std::size_t moved_axes(const std::vector<MotionOutcome>& outcomes);

}  // namespace takt
