#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "eds_parser/table/bus_plan.hpp"
#include "master/core/pdo_inputs.hpp"
#include "master/core/working_image.hpp"

namespace takt {

/// The limit that a refused command would exceed, and the measured value. Values are in SI units.
struct LimitBreach {
  LimitKind kind = LimitKind::range;
  float measured = 0;
  float limit = 0;
};

/// Whether an axis follows its set-points now, so that it moves on from the value that was sent
/// last.
enum class Obeying : std::uint8_t { yes, no };

/// Checks commands against the limits of the plan. A step is measured from the value that was sent
/// last, over the cycles since that value was commanded. An axis that does not follow set-points
/// (because it is not enabled, was not commanded, or its fallback is in force) may also start from
/// its actual position. If the last value or the actual position is outside the range, commands may
/// come back towards the range but not go further away. In profile position mode, only the range is
/// checked. Bus thread only.
class OutputLimits {
 public:
  /// Result of place_of() for an output without limits.
  static constexpr std::uint16_t no_place = 0xFFFF;

  /// Keeps references to all three arguments.
  OutputLimits(const BusPlan& plan, const WorkingImage& image, const PdoInputs& inputs);

  bool empty() const noexcept { return slots_.empty(); }
  std::size_t size() const noexcept { return slots_.size(); }
  const OutputLimit& limit(std::size_t place) const noexcept { return limits_[place]; }
  /// The place of the limits of this output; for a mode of operation, the place of the limits of
  /// its axis.
  std::uint16_t place_of(SignalIndex signal) const noexcept { return places_[signal]; }

  /// The node exchanges PDOs from now on, and nothing was sent to it so far.
  void open(std::size_t node_index) noexcept;

  /// Takes a limit that was read from the device: a range from `low` to `high`, or else the value
  /// `high`. It holds until open() is called again. Returns false, and ignores the limit, if it is
  /// implausible.
  bool narrow(const DeviceLimit& what, std::uint32_t low, std::uint32_t high) noexcept;
  /// This output has a limit in the file or from the device.
  bool bounds(std::size_t place) const noexcept { return slots_[place].bounded; }

  /// Nothing was sent so far, and the device has not sent its actual position yet, so no distance
  /// can be measured. `mode` is the commanded mode of operation of the axis.
  bool lacks_start(std::size_t place, std::int64_t mode) const noexcept;
  /// Checks a command. Returns std::nullopt if `raw` may be sent. `mode` is the commanded mode of
  /// operation of the axis.
  std::optional<LimitBreach> judge(std::size_t place, std::int64_t raw, std::int64_t mode,
                                   Obeying obeying, std::uint64_t cycle) const noexcept;
  /// Notes that a command was outside its limits. Returns true if the previous one was inside.
  bool refuse(std::size_t place, std::uint64_t cycle) noexcept;
  /// Notes that a command was inside its limits. From the next cycle on, this ends the refusal that
  /// refuse() began.
  void forgive(std::size_t place, std::uint64_t cycle) noexcept;
  /// Ends refusals that were not repeated for the time to live of a command.
  void expire(std::uint64_t cycle) noexcept;
  /// A command to this node was outside its limits, and no later one was inside.
  bool holds(std::size_t node_index) const noexcept { return held_[node_index] != 0; }
  bool holds_any() const noexcept { return held_nodes_ != 0; }
  /// Notes that the command is accepted and will be sent.
  void admit(std::size_t place, std::int64_t raw, std::uint64_t cycle) noexcept;
  /// Notes that the value of an output was sent.
  void sent(SignalIndex signal, std::uint64_t cycle) noexcept;

  template <class Archive>
  void keep(Archive& state) noexcept {
    state(slots_, held_, held_nodes_);
  }

 private:
  struct Slot {
    double low = -OutputLimit::none;
    double high = OutputLimit::none;
    double rate = OutputLimit::none;
    double bend = OutputLimit::none;
    bool bounded = false;  ///< there is a limit in the file or from the device
    double value = 0;      ///< the value that was sent last
    double speed = 0;      ///< speed of the last step, per cycle
    double gap = 1;        ///< duration of the last step in cycles
    std::uint64_t cycle = 0;
    std::uint64_t refused_at = 0;
    bool known = false;    ///< a value was sent since open()
    bool news = false;     ///< a command was accepted and is not sent yet
    bool refused = false;  ///< the newest command was outside its limits
    bool profile = false;  ///< the value was sent in profile position mode

    template <class Archive>
    void keep(Archive& state) noexcept {
      state(low, high, rate, bend, bounded, value, speed, gap, cycle, refused_at, known, news,
            refused, profile);
    }
  };
  enum class Start : std::uint8_t { moving, standing };
  /// The step that a command would make.
  struct Way {
    double distance = 0;
    double cycles = 1;
    double at = 0;  ///< value at its end
    Start start = Start::moving;
  };

  const Signal& signal_of(std::size_t place) const noexcept {
    return plan_.layout.signals[limits_[place].signal];
  }
  double number(const Signal& signal, std::int64_t raw) const noexcept;
  double distance(std::size_t place, double from, double to) const noexcept;
  std::optional<double> actual(std::size_t place) const noexcept;
  bool enabled(std::size_t place) const noexcept;
  bool in_profile(std::size_t place, std::int64_t mode) const noexcept;
  double cycles_since(const Slot& slot, std::uint64_t cycle) const noexcept;
  /// The largest permitted difference, rounded to counts that the frame can carry.
  double most(std::size_t place, double counts, double at) const noexcept;
  std::optional<LimitBreach> outside(std::size_t place, double value, bool from_actual) const;
  std::optional<LimitBreach> too_far(std::size_t place, const Way& way) const noexcept;
  std::optional<LimitBreach> too_sharp(std::size_t place, const Way& way) const noexcept;
  Slot fresh_slot(std::size_t place) const noexcept;
  void set_refused(std::size_t place, bool refused) noexcept;

  const BusPlan& plan_;
  const WorkingImage& image_;
  const PdoInputs& inputs_;
  std::vector<OutputLimit> limits_;
  std::vector<std::uint16_t> places_;  ///< place of the limits, by signal
  std::vector<Slot> slots_;            ///< parallel to limits_
  std::vector<std::uint16_t> held_;    ///< by node: number of outputs whose commands are refused
  std::uint32_t held_nodes_ = 0;
  double longest_gap_;  ///< longest time between two commands that counts for a step, in cycles
  double seconds_;      ///< duration of a cycle in seconds
};

}  // namespace takt
