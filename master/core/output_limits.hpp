#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "eds_parser/table/bus_plan.hpp"
#include "master/core/pdo_inputs.hpp"
#include "master/core/working_image.hpp"

namespace takt {

/// The limit that a refused command would break, and by how much. Values are in SI units.
struct LimitBreach {
  LimitKind kind = LimitKind::range;
  float measured = 0;
  float limit = 0;
};

/// Whether an output obeys commands now, so that it moves on from what was sent last.
enum class Obeying : std::uint8_t { yes, no };

/// Holds commands against the limits of the plan. A step counts from the value that was sent last,
/// over the cycles since that was commanded. An axis that doesn't obey set-points (it isn't
/// enabled, hasn't been commanded, or its fallback is in force) may also go on from its actual
/// position. Where the last value or that position is outside, commands may come back from there,
/// not go further. In profile position mode only the range counts. Bus thread only.
class OutputLimits {
 public:
  static constexpr std::uint16_t no_place = 0xFFFF;

  /// Keeps references to all three.
  OutputLimits(const BusPlan& plan, const WorkingImage& image, const PdoInputs& inputs);

  bool empty() const noexcept { return slots_.empty(); }
  std::size_t size() const noexcept { return slots_.size(); }
  const OutputLimit& limit(std::size_t place) const noexcept { return limits_[place]; }
  /// The limits of this output, or those that depend on it because it is the mode of their axis.
  std::uint16_t place_of(SignalIndex signal) const noexcept { return places_[signal]; }

  /// The node exchanges PDOs from now on: nothing was sent to it so far.
  void open(std::size_t node_index) noexcept;

  /// What a device has told of itself, a range from `low` to `high`, else `high`. It holds until
  /// the node is opened again. False: it is implausible, and is ignored.
  bool narrow(const DeviceLimit& what, std::uint32_t low, std::uint32_t high) noexcept;
  /// It has a limit to be held against.
  bool bounds(std::size_t place) const noexcept { return slots_[place].bounded; }

  /// Nothing was sent so far, and the device hasn't sent its actual position yet: no way can be
  /// measured. `mode`: of the axis, as it is commanded.
  bool lacks_start(std::size_t place, std::int64_t mode) const noexcept;
  /// None: `raw` may be sent. `mode`: of the axis, as it is commanded.
  std::optional<LimitBreach> judge(std::size_t place, std::int64_t raw, std::int64_t mode,
                                   Obeying obeying, std::uint64_t cycle) const noexcept;
  /// A command was outside. True: the one before it was not.
  bool refuse(std::size_t place, std::uint64_t cycle) noexcept;
  /// A command was inside. From the next cycle on this ends what refuse() began.
  void forgive(std::size_t place, std::uint64_t cycle) noexcept;
  /// Refusals that nobody has repeated for the time to live of a command end.
  void expire(std::uint64_t cycle) noexcept;
  /// A command to this node was outside, and none has been inside since.
  bool holds(std::size_t node_index) const noexcept { return held_[node_index] != 0; }
  bool holds_any() const noexcept { return held_nodes_ != 0; }
  /// The command is taken: it is what will be sent.
  void admit(std::size_t place, std::int64_t raw, std::uint64_t cycle) noexcept;
  /// This value of an output went out.
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
    bool bounded = false;  ///< there is a limit, of the file or of the device
    double value = 0;      ///< sent last
    double speed = 0;      ///< per cycle, with which it came
    double gap = 1;        ///< cycles that it took
    std::uint64_t cycle = 0;
    std::uint64_t refused_at = 0;
    bool known = false;    ///< something was sent since the node was opened
    bool news = false;     ///< a command was taken and not sent since
    bool refused = false;  ///< the newest command was outside
    bool profile = false;  ///< the value was sent in profile position mode

    template <class Archive>
    void keep(Archive& state) noexcept {
      state(low, high, rate, bend, bounded, value, speed, gap, cycle, refused_at, known, news,
            refused, profile);
    }
  };
  enum class Start : std::uint8_t { moving, standing };
  /// How far and in how many cycles a command would go.
  struct Way {
    double distance = 0;
    double cycles = 1;
    double at = 0;  ///< where it ends
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
  /// What a difference may be at most, in counts that the wire can carry.
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
  std::vector<std::uint16_t> places_;  ///< by signal
  std::vector<Slot> slots_;            ///< beside limits_
  std::vector<std::uint16_t> held_;    ///< by node: how many of its limits are refused
  std::uint32_t held_nodes_ = 0;
  double longest_gap_;  ///< cycles without a command that may count for one way
  double seconds_;      ///< of a cycle
};

}  // namespace takt
