#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <takt/drive402.hpp>
#include <takt/image_input.hpp>
#include <takt/speed_axis_t.hpp>
#include <utility>

namespace takt {

/// The goal that a program sets for a speed axis.
enum class SpeedGoal : std::uint8_t {
  off,       ///< The drive is commanded not to move.
  standing,  ///< The drive is ready to run, and at standstill.
  running,   ///< The drive runs at the target speed.
};

/// What the status word of a speed axis shows.
enum class SpeedState : std::uint8_t { unknown, fault, not_ready, ready };

/// One speed axis: turns each image into its control word and its set speed. It uses neither LCM
/// nor a clock.
class SpeedAxis {
 public:
  /// `words` must have passed is_usable().
  explicit SpeedAxis(speed_axis_t words) : words_{std::move(words)} {}

  /// Returns true if the axis can be commanded in this layout: its signals are outputs and inputs
  /// of one node, and its scales are finite and not 0.
  static bool is_usable(const speed_axis_t& words, const ImageInput& input);

  /// Sets the goal. The set speed changes by at most `acceleration` per second, or at once if that
  /// is 0: the drive then follows its own ramp.
  void set_goal(SpeedGoal goal, double speed = 0.0, double acceleration = 0.0) noexcept;
  /// Begins to reset a fault.
  void reset_fault() noexcept;
  /// Takes the status of the newest image. A drive that has left Operation enabled by itself, and a
  /// fault, make the goal SpeedGoal::off.
  void read(const ImageInput& input) noexcept;
  /// Computes the commands, once for each image, after read().
  void step(const ImageInput& input) noexcept;

  /// Returns the value of the control word that is to be sent.
  std::int64_t control() const noexcept { return control_; }
  /// Returns the raw set speed that is to be sent.
  std::int64_t set_speed() const noexcept;
  /// Returns true if the object of the set speed can hold this speed.
  bool can_hold(double speed, const ImageInput& input) const noexcept;

  const speed_axis_t& words() const noexcept { return words_; }
  SpeedGoal goal() const noexcept { return goal_; }
  SpeedState state() const noexcept { return state_; }
  /// Returns true if the set speed has come to 0 and the drive shows that it is at standstill.
  bool stands() const noexcept;
  /// Returns true if the goal is to run and the status word shows that the drive runs. Also returns
  /// true if the status word cannot show this.
  bool runs() const noexcept;
  /// Returns the actual speed, or the commanded one if no TPDO carries it.
  double speed() const noexcept { return words_.actual_speed < 0 ? commanded_ : actual_; }
  /// Returns a sentence on why the drive would not run, or an empty text.
  std::string why_not_ready() const;

 private:
  bool is_stale(const ImageInput& input) const noexcept;
  void leave_with_drive() noexcept;
  void ramp(double seconds) noexcept;
  std::int64_t word_for_goal() noexcept;
  std::int64_t word_to_move() const noexcept;
  std::int64_t reset_word() noexcept;

  speed_axis_t words_;
  DriveSequence drive_;  // state machine of CiA 402
  SpeedGoal goal_ = SpeedGoal::off;
  SpeedState state_ = SpeedState::unknown;
  double target_ = 0.0;
  double acceleration_ = 0.0;
  double commanded_ = 0.0;
  double actual_ = 0.0;
  std::int64_t actual_counts_ = 0;
  std::int64_t control_ = 0;
  std::int64_t cycle_ = -1;
  std::uint16_t status_ = 0;
  int silent_images_ = 0;           // number of images in sequence without the status word
  bool was_enabled_ = false;        // state in the newest image; for the sequence of CiA 402
  std::optional<int> reset_steps_;  // images since the reset began; empty if none runs
};

}  // namespace takt
