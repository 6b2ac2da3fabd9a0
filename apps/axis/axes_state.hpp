#pragma once
#include <chrono>
#include <cstdint>
#include <fmt/format.h>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <takt/motion.hpp>
#include <takt/motion_goal_t.hpp>
#include <utility>
#include <vector>

#include "apps/axis/group/surroundings.hpp"
#include "apps/axis/speed_drives.hpp"
#include "apps/axis/stream/stream_buffer.hpp"

namespace takt {

/// Objects of profile position mode, CiA 402-2.
inline constexpr std::uint16_t profile_velocity = 0x6081;
inline constexpr std::uint16_t profile_acceleration = 0x6083;
inline constexpr std::uint16_t profile_deceleration = 0x6084;

inline std::unexpected<Obstacle> obstacle(Obstacle::Kind kind, std::string text) {
  return std::unexpected{Obstacle{.kind = kind, .text = std::move(text)}};
}

/// Bit 10 of the statusword. CiA 402-2.
inline constexpr std::uint16_t target_reached = 0x0400;
/// Number of cycles after a command in which a drive may still show its old statusword.
inline constexpr std::int64_t settled_cycles = 10;
/// Number of status_t (10 in a second) in sequence in which another program holds an axis before
/// enable() gives up. That program may have died, while its last command is still valid.
inline constexpr int held_statuses = 20;

/// The state and the functions of an Axes. Waiting is in axes_state.cpp; each of the other files
/// has the code of the calls after which it is named: drives, halt, homing, motions, stream, gear,
/// speed, set_points, objects, signals, ramps and probe.
class Axes::State {
 public:
  using Clock = ProgramClock;
  using Index = AxisControl::Index;
  using Values = Eigen::Ref<const Eigen::VectorXd>;

  State(std::unique_ptr<Transport> lcm, AxesOptions given);

  /// Waits for the layout and the first image, and finds the axes in them.
  Done find();
  Done run(std::chrono::nanoseconds time);
  /// Returns true while the layout in which the axes were found is that of the bus: taktd has not
  /// restarted.
  bool is_current() const noexcept;

  Done enable();
  Done disable();
  Done reset();
  Done set_mode(DriveMode wanted);
  Done set_mode(Index number, DriveMode wanted);
  Done halt();
  Done resume();
  Done quick_stop();

  using Data = std::vector<std::uint8_t>;
  /// An object of a node.
  struct Object {
    std::string node;
    std::uint16_t index;
    std::uint8_t sub = 0;
  };
  std::expected<Data, Obstacle> transfer(const std::string& service, const Object& object,
                                         std::span<const std::uint8_t> data);
  std::expected<double, Obstacle> signal(const std::string& name);
  Done set(const std::string& name, double value);

  Done command_velocities(const Values& values);
  Done command_torques(const Values& values);
  Done profile_move(const Values& positions, const ProfileBounds& bounds, const ProfileMove& how);
  std::expected<double, Obstacle> touch_probe(Index number, const ProbeOptions& wanted);

  Done home(const HomingOptions& wanted);
  /// These functions return what taktd has reported last about the axis with this index in the
  /// group.
  bool homed(Index axis) const;
  bool needs_homing(Index axis) const;

  Done begin(const std::string& kind, const Values& values, const MotionBounds& bounds);
  Done gear(const Gear& gear, const MotionBounds& bounds);
  Done wait_locked(std::chrono::nanoseconds longest);
  Done begin_stream(const MotionBounds& bounds);
  Done stream(std::span<const PathPoint> points);
  double stream_left() const;
  bool locked() const;
  Done jog(const Values& velocities, const MotionBounds& bounds);
  Done wait(std::chrono::nanoseconds longest);
  Done stop();
  bool moving() const;

  // The calls for speed axes; see axes_speed.cpp.
  Done enable_speed();
  Done disable_speed();
  Done reset_speed();
  Done run_speed(const Values& velocities, const MotionBounds& bounds);
  Done wait_speed(std::chrono::nanoseconds longest);
  Done stop_speed();
  /// Returns the obstacle of a call that only CiA 402 drives have, for a speed axis.
  Done no_drive() const;
  /// Returns the obstacle of a call that needs positions, for a speed axis.
  Done no_position() const;

  Index size() const noexcept { return static_cast<Index>(names.size()); }
  /// Returns the index in the group of the axis with this index in an Axes.
  Index in_group(Index axis) const { return axes[at(axis)]; }
  static std::size_t at(Index axis) noexcept { return static_cast<std::size_t>(axis); }

  AxisGroup group;
  AxesOptions options;
  std::vector<Index> axes;           // axes of the group; empty if these are speed axes
  std::optional<SpeedDrives> speed;  // the axes if they are speed axes
  std::vector<std::string> names;    // parallel to `axes`
  std::vector<std::string> units;

 private:
  /// The messages that this program sends without a call that requests them.
  enum class Sending : std::uint8_t {
    nothing,  ///< The program only listens.
    /// Controlwords with each image, and signs of life, while the drives change their states.
    controls,
    alive,  ///< Signs of life while the drives are enabled.
  };
  /// The state to which this program has brought the drives. It determines whether the program may
  /// move them.
  enum class Readiness : std::uint8_t {
    not_enabled,
    enabled,  ///< enabled by enable()
    halted,   ///< bit 8 of their controlwords is set
  };
  /// States whether AxesOptions::interrupted can end a wait.
  enum class Interruption : std::uint8_t { obeyed, ignored };
  /// The state of the newest motion.
  enum class Course : std::uint8_t { none, unanswered, runs, done, refused, stopped, replaced };
  /// A stream from begin_stream() on.
  struct Stream {
    StreamBuffer buffer;
    std::vector<motion_goal_t> goals;
    bool begun = false;  ///< the first points of the stream were sent
  };
  using Condition = std::function<bool()>;
  using AxisCondition = std::function<bool(Index)>;

  struct SetPoints;
  Done set_mode(std::span<const Index> chosen, DriveMode wanted);
  Done check_set_points(const Values& values, const SetPoints& kind);
  Done send_set_points(const Values& values, const SetPoints& kind);
  void learn_decelerations();
  Eigen::VectorXd sent_velocities() const;
  std::optional<Done> slow_down();
  /// Sets the target velocities and target torques to 0.
  void end_set_points();
  Eigen::VectorXd in_group(const Values& values, double otherwise) const;
  std::string refusal() const;
  Done write_profile(std::uint16_t index, const Eigen::VectorXd& values);
  Done hand_over(std::span<const Index> chosen, const Values& positions, SetPointTiming timing);
  Done wait_for_profiles(std::chrono::nanoseconds longest);
  Done stop_set_points();
  Eigen::VectorXd actual_positions() const;

  /// Returns an object of this axis; `index` is its index on the first axis of a device.
  Object object_of_axis(Index axis, std::uint16_t index) const;
  Done write_of_axis(Index axis, std::uint16_t index, std::int64_t raw, std::size_t bytes);
  std::expected<std::int64_t, Obstacle> read_of_axis(Index axis, std::uint16_t index);
  Done wait_for_probe(Index axis, unsigned bits, unsigned wanted, std::chrono::nanoseconds longest);

  enum class Signals : std::uint8_t { all, outputs };
  std::optional<std::size_t> place_of(const Object& object, Signals among) const;
  /// Returns the place in the image of "io.name" or "io.0x6000:1".
  std::expected<std::size_t, Obstacle> find_signal(const std::string& name, Signals among) const;
  std::expected<std::int16_t, Obstacle> node_id(const std::string& name) const;
  double value_at(std::size_t place) const;
  /// Returns true if the output at this place controls an axis.
  bool leads(std::size_t place) const;
  Done set_raw(std::size_t place, std::int64_t raw);
  std::string refusal_of(const std::string& node) const;
  void send_held();
  /// Sends the values that follow from a new image.
  void send_outputs();
  /// Gives up all set-points if this program was silent for longer than its timeout.
  void give_up_after_silence();

  /// Takes the messages that have come, and sends what is due.
  Done step(Interruption interruption);
  /// Waits until `reached` returns true. Returns std::nullopt if `longest` is over before.
  std::optional<Done> wait_until(const Condition& reached, std::chrono::nanoseconds longest,
                                 Interruption interruption = Interruption::obeyed);
  Done restarted();
  Done find_position_axes();
  bool find_speed_axes();
  bool is_speed_axis(const std::string& name) const;
  bool lacks_speed_axes() const;
  void send_speeds();
  void end_stopped_run();
  Done begin_run(const Values& velocities, const MotionBounds& bounds);
  std::string why_speed_ended() const;
  Done check_speeds(const Values& velocities, const MotionBounds& bounds) const;
  /// Sends a sign of life if one is due. The sign of life names the axes only if a running jog has
  /// to continue, because the names renew the jog.
  void keep_alive();
  std::vector<motion_goal_t> goals() const;
  bool all(const AxisCondition& is) const;
  bool any(const AxisCondition& is) const;
  /// Returns the text of the newest event of this kind that contains `part` and has come since the
  /// newest motion began, or an empty text.
  std::string event_text(std::string_view kind, std::string_view part = {}) const;

  struct HomingRun;
  Done home(std::span<const Index> chosen, std::chrono::nanoseconds longest);
  Done enter_homing(std::span<const Index> chosen);
  Done run_homing(std::span<const Index> chosen, std::chrono::nanoseconds longest);
  std::string trouble_of(HomingRun& run);
  std::string why_not_in_homing_mode(std::span<const Index> chosen) const;
  Done leave_homing(std::span<const Index> chosen);

  bool is_ready(Index axis) const;
  bool all_ready() const;
  bool all_enabled() const;
  /// Returns true if taktd runs the motions of this axis: it is in cyclic synchronous position
  /// mode, or in interpolated position mode if the axis has no target position (0x607A).
  bool is_in_mode_of_motions(Index axis) const;
  bool all_in_mode_of_motions() const;
  /// Chooses what to send. Drives in other modes than that of taktd's motions need commands with
  /// each image.
  void send_as_modes_need();
  /// Returns the obstacle of a call before enable().
  Done not_enabled() const;
  Done check_halt() const;
  void end_halt(Readiness next);
  /// Returns true if the newest image shows that the controlword was sent with the Halt bit.
  bool shows_halt(Index axis) const;
  /// Waits until the actual positions of these axes no longer change, or their drives report
  /// standstill, and taktd moves none of them.
  std::optional<Done> wait_for_rest(std::span<const Index> chosen, Interruption interruption);
  /// Puts the name and the statusword of each of these axes into `words`.
  std::string text_of_each(std::span<const Index> chosen,
                           fmt::format_string<const std::string&, std::uint16_t> words) const;
  std::string why_not_ready_text() const;

  /// Waits until a motion may begin, or returns the reason why no motion may begin.
  Done wait_for_begin(const MotionBounds& bounds);
  /// Returns the goals of all axes with these limits.
  std::vector<motion_goal_t> goals_within(const MotionBounds& bounds) const;
  /// Returns the id of a motion that begins now.
  std::int32_t note_begin();
  /// Waits until taktd has answered the newest motion. If the motion does not run then, returns how
  /// it has ended.
  Done wait_for_answer();
  Course course() const;
  /// Returns true if a motion runs, or if taktd may still answer it.
  bool is_under_way(Course course) const;
  Done give_points(std::span<const PathPoint> points);
  void finish_stream();
  /// Sends the points that are due.
  void serve_stream();
  bool stream_goes_on() const;
  Course course_of(Index axis) const;
  std::string reason(Course course) const;
  Done ended();
  void send_stop();
  /// Repeats the stop until all axes are at rest and no earlier motion can still begin.
  Done stop_now();

  Sending sending_ = Sending::nothing;
  std::vector<Index> commanded_;  // axes whose controlwords are sent
  Readiness readiness_ = Readiness::not_enabled;
  std::map<std::size_t, std::int64_t> held_;  // raw values of outputs, by their place in the image
  bool has_set_points_ = false;               // commanded velocities or torques are in effect
  // Decelerations of target velocities that drives follow at once.
  Eigen::VectorXd decelerations_{};
  std::optional<Eigen::VectorXd> profile_targets_;  // newest targets since the axes were stopped
  Clock::time_point last_values_{};  // time of the newest image from which outputs were sent
  std::string lost_text_;         // reason why set-points were discarded, until a call returns it
  std::int64_t request_id_ = 0;   // id of the newest request
  std::int32_t id_ = 0;           // id of the newest motion
  bool has_motion_ = false;       // false before the first motion, and after a stop
  bool has_begun_ = false;        // a motion has begun since the drives were enabled
  bool jog_goes_on_ = false;      // the newest motion is a jog, and no call has ended it
  std::optional<Stream> stream_;  // the stream, until it has ended
  std::int64_t session_ = 0;      // session of the layout in which the axes were found
  Clock::time_point motion_begin_{};
  std::int64_t stop_cycle_ = -1;   // cycle of the image from which the newest stop was sent
  Clock::time_point last_sent_{};  // time of the newest sign of life
  Clock::time_point last_image_ = Clock::now();
  std::string stopped_text_;     // reason why this object has stopped the speed axes
  std::vector<event_t> events_;  // events since the newest motion began
};

}  // namespace takt
