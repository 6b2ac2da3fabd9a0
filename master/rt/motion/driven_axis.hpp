#pragma once
#include <cstdint>
#include <vector>

#include "eds_parser/table/motion_axes.hpp"
#include "master/core/pdo/pdo_exchange.hpp"
#include "master/motion/beat/axis_report.hpp"
#include "master/motion/beat/homing_watch.hpp"

namespace takt {

/// Connects the motions of one axis with the image: reads the state of the drive, and writes the
/// set-points of the motion. Numbers of motions are in the units of the network file. Bus thread
/// only.
class DrivenAxis {
 public:
  DrivenAxis(const MotionAxis& axis, const BusPlan& plan);

  std::uint8_t node_index() const noexcept { return axis_.node_index; }

  /// Returns the state of the drive in this beat. `exchanging` states whether its node exchanges
  /// PDOs, `last` is the report of the previous beat.
  motion::AxisInput read(PdoExchange& pdos, bool exchanging,
                         const motion::AxisReport& last) noexcept;
  /// Commands the target position while the axis moves, and the velocity and the torque as its
  /// offsets. While the drive does not follow its target position, the target position follows the
  /// actual position, so that the drive does not jump when it is enabled. This is done if a motion
  /// has commanded the target position last or if nobody has commanded it. In homing mode it is
  /// always done, because the coordinates of the drive change. After a motion, the target position
  /// also follows the actual position while a Halt stops the drive, which bit 12 of its statusword
  /// shows. Returns false if a set-point was not taken, see PdoOutputs::lead().
  bool write(PdoOutputs& outputs, const motion::AxisReport& report, OutputMoment moment) noexcept;
  /// Returns true if no set-point is taken at present, because the master itself stops the axis.
  bool is_overruled(const PdoOutputs& outputs) const noexcept {
    return outputs.is_overruled(axis_.target);
  }
  /// Forgets that the axis is homed, because its node exchanges no PDOs in this cycle: the device
  /// may have been switched off.
  void lose_home() noexcept { homing_.step({.heard = false}); }
  /// Keeps the commands of all outputs of the node valid in this cycle.
  void keep_alive(PdoOutputs& outputs, OutputMoment moment) const noexcept {
    for (const SignalIndex output : node_outputs_) outputs.keep_alive(output, moment);
  }

  template <class Archive>
  void keep(Archive& state) noexcept {
    state(condition_, silent_beats_, unsent_beats_, frames_, sent_target_, ignores_target_,
          in_homing_mode_, tells_following_, obeys_halt_, follows_actual_, written_, writer_,
          homing_);
  }

 private:
  /// The origin of the newest target position.
  enum class Writer : std::uint8_t {
    others,     ///< set-points of applications, or a fallback
    motion,     ///< a motion that has ended
    in_motion,  ///< a motion that runs
    refused,    ///< a motion of which a later set-point was not taken
  };
  /// Converts between the raw value of a signal and a number in its unit.
  struct Scale {
    double scale = 1.0;
    double offset = 0.0;
    Turn turn{};  ///< turn of a rotary axis; its motions continue over several turns

    double number(std::int64_t raw) const noexcept {
      return static_cast<double>(static_cast<std::int32_t>(raw)) * scale + offset;
    }
    /// Returns the number of this raw value that is nearest to `reference`. The numbers of a rotary
    /// axis differ by whole turns.
    double number_near(std::int64_t raw, double reference) const noexcept {
      return turn.in_unit(scale, offset).nearest(number(raw), reference);
    }
    std::optional<std::int64_t> raw(double number) const noexcept;
  };
  static Scale scale_of(const BusPlan& plan, SignalIndex signal) noexcept;
  /// Number of beats in a row without the statusword after which a drive counts as silent.
  static constexpr std::uint8_t most_silent_beats = 3;

  static std::uint32_t longest_wait_of(const BusPlan& plan, SignalIndex signal) noexcept;
  motion::AxisCondition condition(PdoExchange& pdos, bool exchanging) noexcept;
  bool interpolates(const WorkingImage& image, bool shows_activity) const noexcept;
  void count_unsent(const RpdoStatus& rpdo, std::int64_t target) noexcept;
  motion::AxisCondition without_statusword() noexcept;
  motion::HomingState homing(const PdoExchange& pdos, bool exchanging) noexcept;
  bool lead(PdoOutputs& outputs, const motion::State& state, OutputMoment moment) noexcept;
  bool end_motion(PdoOutputs& outputs, const motion::State& state, OutputMoment moment) noexcept;
  void stop_leading(PdoOutputs& outputs) noexcept;
  void follow_actual(PdoOutputs& outputs, const motion::AxisReport& report,
                     OutputMoment moment) noexcept;
  std::int64_t torque(const motion::State& state) const noexcept;
  bool lead_offsets(PdoOutputs& outputs, std::int64_t speed, std::int64_t torque,
                    OutputMoment moment) noexcept;
  void clear_offsets(PdoOutputs& outputs) const noexcept;

  MotionAxis axis_;
  Scale position_;
  Scale velocity_;
  Scale target_;
  Scale velocity_offset_;
  Scale torque_offset_;
  std::int64_t lowest_torque_ = 0;  ///< lower limit of the torque offset, in counts
  std::int64_t highest_torque_ = 0;
  std::vector<SignalIndex> node_outputs_;
  motion::AxisCondition condition_ = motion::AxisCondition::disabled;
  std::size_t row_;                 ///< row of the RPDO that carries the target position
  std::uint32_t longest_wait_;      ///< beats in which a set-point may wait for its frame
  std::uint32_t unsent_beats_ = 0;  ///< beats in a row in which a new target position was not sent
  std::uint32_t frames_ = 0;        ///< frames of the RPDO until the last beat
  std::int64_t sent_target_ = 0;    ///< target position in the newest of these frames
  std::uint8_t silent_beats_ = 0;
  bool ignores_target_ = false;  ///< the statusword or the mode of this beat shows that the drive
                                 ///< ignores its target position
  bool in_homing_mode_ = false;
  bool tells_following_ = false;  ///< bit 12 of the statusword was set before, so it is in use
  bool obeys_halt_ = false;       ///< a Halt stops the drive in this beat
  bool follows_actual_ = false;   ///< the target position follows the actual one in this beat
  std::int64_t written_ = 0;      ///< the last target position that a motion has commanded
  Writer writer_ = Writer::others;
  motion::HomingWatch homing_;
};

}  // namespace takt
