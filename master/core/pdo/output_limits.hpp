#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "eds_parser/table/bus_plan.hpp"
#include "master/core/pdo/notation.hpp"
#include "master/core/pdo/pdo_inputs.hpp"
#include "master/core/pdo/working_image.hpp"

namespace takt {

/// The limit that a refused command would exceed, and the measured value. Values are in SI units.
struct LimitBreach {
  LimitKind kind = LimitKind::range;
  float measured = 0;
  float limit = 0;
};

/// States whether an axis follows its set-points now, so that its next step begins at the value
/// that was sent last.
enum class Obeying : std::uint8_t { yes, no };

/// States whether a command contains a new set-point, or only makes the set-point effective that
/// was sent before.
enum class SetPointAge : std::uint8_t { commanded, held };

/// The raw values that a command gives to a limited output and to the other outputs of its axis.
struct AxisCommand {
  std::int64_t value = 0;   ///< value of the limited output
  std::int64_t offset = 0;  ///< 60B0, 60B1 or 60B2, if it is an output
  std::int64_t mode = 0;    ///< 6060, if it is an output
  std::int64_t order = 0;   ///< 6040, if it is an output
  SetPointAge age = SetPointAge::commanded;
};

/// Checks commands against the limits of the plan. The set-point of an axis is the sum of a target
/// and of its offset; in modes in which the drive does not add them, each of them is checked alone.
/// A step is measured from the value that was sent last, and is divided by the number of cycles
/// since that value was commanded. If an axis is not enabled and its actual position is known, the
/// step is measured from the actual position, because the axis would start there. If an axis was
/// not commanded, or its fallback is effective, its step may begin at either of these two values.
/// If the last value or the actual position is outside the range, commands may move back towards
/// the range but not further away from it. In modes in which the drive does not follow each
/// position, only the range of positions is checked. The set speed of an inverter is checked
/// together with the direction and the stop in its control word. A stop is never refused, because
/// the drive has its own ramp. Bus thread only.
class OutputLimits {
 public:
  /// Result of place_of() for an output without limits.
  static constexpr std::uint16_t no_place = 0xFFFF;

  /// Keeps references to all three arguments.
  OutputLimits(const BusPlan& plan, const WorkingImage& image, const PdoInputs& inputs);

  bool empty() const noexcept { return slots_.empty(); }
  std::size_t size() const noexcept { return slots_.size(); }
  const OutputLimit& limit(std::size_t place) const noexcept { return limits_[place]; }
  /// Returns the place of the limits of this output.
  std::uint16_t place_of(SignalIndex signal) const noexcept { return places_[signal]; }
  /// Returns the places of the outputs whose check depends on this output, because this one is
  /// their controlword, their mode of operation or their offset.
  std::span<const std::uint16_t> dependents(SignalIndex signal) const noexcept {
    return dependents_[signal];
  }
  /// Returns true if a command to this output is checked: the output is limited, or it is the
  /// offset or the mode of operation of a limited output.
  bool judges(SignalIndex signal) const noexcept { return judged_[signal] != 0; }
  /// Returns true if the output at `place` is an offset, and the drive certainly adds it to its
  /// target in this commanded mode, so that the check of the target covers it.
  bool covered_by_target(std::size_t place, std::int64_t mode) const noexcept;

  /// Must be called when the node begins to exchange PDOs and nothing was sent to it yet.
  void open(std::size_t node_index) noexcept;

  /// Takes a limit that was read from the device. It is a range from `low` to `high`, or only the
  /// value `high`. It is valid until open() is called again. Returns false, and ignores the limit,
  /// if it is implausible.
  bool narrow(const DeviceLimit& what, std::uint32_t low, std::uint32_t high) noexcept;
  /// Returns false if no limit depends on commands to this output now, so that all of them are
  /// permitted and need not be noted. Most drives report no limits.
  bool concerns(SignalIndex signal) const noexcept { return concerned_[signal] != 0; }
  /// Returns false if concerns() is false for every output. No command is refused then.
  bool concerns_any() const noexcept { return concerns_any_; }
  /// Returns true if this output has a limit in the file or from the device.
  bool bounds(std::size_t place) const noexcept { return slots_[place].bounded; }

  /// Returns true if nothing was sent so far, and the device has not sent its actual position yet,
  /// so no distance can be measured. `mode` is the commanded mode of operation of the axis.
  bool lacks_start(std::size_t place, std::int64_t mode) const noexcept;
  /// Checks a command. Returns std::nullopt if it may be sent.
  std::optional<LimitBreach> judge(std::size_t place, const AxisCommand& command, Obeying obeying,
                                   std::uint64_t cycle) const noexcept;
  /// Returns true if the controlword `order` asks an axis that is not enabled to enable operation,
  /// or if it makes a speed axis run, or run in the other direction.
  bool begins(std::size_t place, std::int64_t order) const noexcept;
  /// Returns the controlword of the axis that was sent last; 0 if none was sent.
  std::int64_t order(std::size_t place) const noexcept { return slots_[place].order; }
  /// Notes the actual positions of this cycle. Call this once in each cycle.
  void remember() noexcept;
  /// Notes that the command is accepted and will be sent.
  void admit(std::size_t place, const AxisCommand& command, std::uint64_t cycle) noexcept;
  /// Notes that the motion of the axis stood still during `cycles` cycles before this one. When the
  /// next step is divided by its cycles, they do not count.
  void pass_over(std::size_t place, std::uint64_t cycles, std::uint64_t cycle) noexcept;
  /// Notes that the value of an output was sent.
  void sent(SignalIndex signal, std::uint64_t cycle) noexcept;

  template <class Archive>
  void keep(Archive& state) noexcept {
    state(slots_);
    find_concerned();
  }

 private:
  /// Number of cycles whose actual positions are stored. An application computes a command from an
  /// image that is some cycles old, and an axis that coasts or is pushed has moved since.
  static constexpr std::uint8_t cycles_remembered = 4;

  struct Slot {
    double low = -OutputLimit::none;
    double high = OutputLimit::none;
    double rate = OutputLimit::none;
    double bend = OutputLimit::none;
    bool bounded = false;  ///< there is a limit in the file or from the device
    double value = 0;      ///< the value of this output alone that was sent last
    double offset = 0;     ///< the offset that was sent last, in counts of the value
    std::optional<double>
        set_point{};   ///< what was sent last to the drive: in some modes `value` plus `offset`
    double speed = 0;  ///< speed of the last step, per cycle
    double gap = 1;    ///< duration of the last step in cycles
    double allowed =
        0;  ///< set speed only: part of the permitted change of speed that is not used yet
    std::uint64_t cycle = 0;
    bool known = false;      ///< a value was sent since open()
    bool unsent = false;     ///< a command was accepted and is not sent yet
    bool idle = false;       ///< the value was sent in a mode that does not follow each set-point
    std::int64_t order = 0;  ///< the controlword that was sent last
    std::array<double, cycles_remembered> positions{};  ///< actual positions of the last cycles
    std::uint8_t remembered = 0;                        ///< number of valid `positions`

    template <class Archive>
    void keep(Archive& state) noexcept {
      state(low, high, rate, bend, bounded, value, offset, set_point, speed, gap, allowed, cycle,
            known, unsent, idle, order, positions, remembered);
      // A damaged checkpoint may contain any number.
      remembered = std::min(remembered, cycles_remembered);
    }
  };
  enum class Start : std::uint8_t { moving, standing };
  /// The step that the axis would make by a command.
  struct Way {
    double distance = 0;
    double cycles = 1;
    double at = 0;  ///< value at the end of the step
    Start start = Start::moving;
  };

  /// Returns true if the controlword asks the axis to enable operation.
  static bool enables(std::int64_t order) noexcept {
    constexpr std::int64_t enable_operation = 0x0F;
    return (order & enable_operation) == enable_operation;
  }
  const Signal& signal_of(std::size_t place) const noexcept {
    return plan_.layout.signals[limits_[place].signal];
  }
  double number(SignalIndex signal, std::int64_t raw) const noexcept {
    return notations_[signal].number(raw);
  }
  double distance(std::size_t place, double from, double to) const noexcept;
  std::optional<double> actual(std::size_t place) const noexcept;
  double offset(std::size_t place, std::int64_t raw) const noexcept;
  struct ModesFollowed;
  double set_point(std::size_t place, const AxisCommand& command,
                   ModesFollowed modes) const noexcept;
  double last_set_point(std::size_t place, ModesFollowed modes) const noexcept;
  AxisCommand image_command(std::size_t place) const noexcept;
  double distance_from_actual(std::size_t place, double value, bool from_earlier) const noexcept;
  void note_sent(std::size_t place, std::uint64_t cycle) noexcept;

  // These functions are in output_limits_speed.cpp.
  std::optional<LimitBreach> judge_speed(std::size_t place, const AxisCommand& command,
                                         Obeying obeying, std::uint64_t cycle) const noexcept;
  double allowance(std::size_t place, std::uint64_t cycle) const noexcept;
  void note_speed_sent(std::size_t place, std::uint64_t cycle) noexcept;

  // These functions are in output_limits_axis.cpp.
  bool enabled(std::size_t place) const noexcept;
  bool starts_from_actual(std::size_t place, std::int64_t order) const noexcept;
  /// States whether the axis follows a set-point that contains this output: in the commanded mode,
  /// and in the mode that the drive displays.
  struct ModesFollowed {
    bool commanded = false;
    bool shown = false;
    bool ramps = false;  ///< in both modes, the drive reaches the set-point along its own ramps

    /// While the drive changes the mode, it may still follow the output.
    bool any() const noexcept { return commanded || shown; }
    bool both() const noexcept { return commanded && shown; }
  };
  ModesFollowed modes_followed(std::size_t place, std::int64_t mode) const noexcept;
  bool follows_each(std::size_t place, ModesFollowed modes) const noexcept;
  bool starts_from_last(std::size_t place, ModesFollowed modes) const noexcept;
  double cycles_since(const Slot& slot, std::uint64_t cycle) const noexcept;
  /// Returns the largest permitted difference, rounded to counts that the frame can carry.
  double most(std::size_t place, double counts, double at) const noexcept;
  /// Returns true if a difference is larger than permitted.
  bool exceeds(std::size_t place, double length, double counts, double at) const noexcept;
  std::optional<LimitBreach> outside(std::size_t place, double value,
                                     bool from_actual) const noexcept;
  std::optional<LimitBreach> too_far(std::size_t place, const Way& way) const noexcept;
  std::optional<LimitBreach> too_sharp(std::size_t place, const Way& way) const noexcept;
  bool checked(std::size_t place) const noexcept;
  void find_concerned() noexcept;
  Slot fresh_slot(std::size_t place) const noexcept;

  const BusPlan& plan_;
  const WorkingImage& image_;
  const PdoInputs& inputs_;
  std::vector<OutputLimit> limits_;
  std::vector<Notation> notations_;                     ///< by signal
  std::vector<std::uint16_t> places_;                   ///< place of the limits, by signal
  std::vector<std::vector<std::uint16_t>> dependents_;  ///< by signal, see dependents()
  std::vector<std::uint8_t> judged_;                    ///< by signal, see judges()
  std::vector<std::uint8_t> concerned_;                 ///< by signal, see concerns()
  bool concerns_any_ = false;
  std::vector<Slot> slots_;  ///< parallel to limits_
  double longest_gap_;  ///< longest time between two commands that counts for a step, in cycles
  double seconds_;      ///< duration of a cycle in seconds
};

}  // namespace takt
