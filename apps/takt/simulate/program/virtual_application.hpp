#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <takt/axis_control.hpp>
#include <takt/image_input.hpp>
#include <takt/motion_command_t.hpp>
#include <vector>

#include "apps/takt/simulate/program/motion_commander.hpp"
#include "apps/takt/simulate/program/stage.hpp"
#include "apps/takt/simulate/program/virtual_lcm.hpp"
#include "master/gateway/bridge.hpp"
#include "master/sim/random.hpp"

namespace takt {

/// The way in which a program moves its axes.
enum class Commanding : std::uint8_t {
  set_points,  ///< the program moves the axes by a set-point for each image
  motions,     ///< the program moves the axes by motions that taktd runs, see MotionCommander
  by_turns,    ///< the program uses both, in turns of random length
};

/// A message about motions that a program sends. A motion_gear_t is a command of the kind "gear";
/// the messages of a stream have the kinds "stream" and "points".
struct CommandedMotion {
  const motion_command_t& command;
  Time computed_from{};  ///< SYNC time of the image that the program has seen
  Time points_until{};   ///< time of the newest point of a stream, from the begin of the stream on
  const motion_gear_t* gear = nullptr;      ///< the message if it is about a gear
  const motion_stream_t* stream = nullptr;  ///< the message if it is about a stream
};

struct ApplicationOptions {
  std::string name;         ///< sender name in the program's commands
  unsigned number = 0;      ///< number of the program, 0..7
  std::vector<bool> nodes;  ///< nodes that the program commands, in the order of BusPlan::nodes
  Commanding commanding = Commanding::set_points;

  /// Called with each command that is sent and the SYNC time of the image it was computed from.
  std::function<void(const command_t& command, Time computed_from)> commanded{};
  /// Called with each message about motions that is sent.
  std::function<void(const CommandedMotion& motion)> motion_commanded{};
  /// Called when the program gives up its outputs.
  std::function<void(Time now)> released{};
  /// Called if the program has received images for a long time and could use none of them.
  std::function<void(const std::string& what)> deaf{};
  /// For tests: returns the instance that the program uses. `own` is the random instance of the
  /// program.
  std::function<std::int64_t(std::int64_t own)> instance{};
  /// For tests: returns false if the program shall ignore this image.
  std::function<bool(const image_t& image)> hears{};
};

/// A program that moves axes with the axis library: it takes the newest image and sends one
/// command. It counts its positions up, and down again near a limit, so that each value on the wire
/// shows which program sent it and when. If a drive also has target velocities and torques, they
/// rise and fall slowly. If a drive has offsets, they take a half of each target velocity and
/// torque, and each jump of a position.
class VirtualApplication final : public Actor {
 public:
  VirtualApplication(const BusPlan& plan, VirtualLcm& lcm, ApplicationOptions options,
                     sim::Random random);

  /// Starts the program as a new process.
  void start();
  void kill();
  /// Gives up the outputs and ends the program.
  void end(Time now);
  /// Shifts the set-points of the next command by this many counts: target velocities and torques
  /// of the drives that have them, positions of the others.
  void jump(std::int64_t counts) noexcept { jump_ = counts; }
  void stall(Time until) noexcept { stalled_until_ = std::max(stalled_until_, until); }
  bool runs() const noexcept { return running_; }
  const std::string& name() const noexcept { return options_.name; }
  unsigned number() const noexcept { return options_.number; }
  const std::vector<bool>& nodes() const noexcept { return options_.nodes; }
  bool commands(std::size_t node_index) const { return options_.nodes[node_index]; }
  /// From now on the program moves its axes in this way.
  void command_by(Commanding commanding) noexcept { options_.commanding = commanding; }
  /// From now on the program needs this additional time for each image.
  void slow_down(Time reaction) noexcept { slowness_ = reaction; }
  /// Returns the number of axes that the program moves at this moment.
  std::size_t leads() const noexcept;
  std::uint64_t images() const noexcept { return images_; }    ///< images used
  std::uint64_t sent() const noexcept { return sent_; }        ///< commands sent
  std::uint64_t motions() const noexcept { return motions_; }  ///< messages about motions sent
  std::uint64_t dropped() const noexcept { return lcm_.dropped(); }

  /// Describes the program by its number and the statuswords of its axes.
  std::string text() const;

  Time next() const noexcept override;
  void act(Time now) override;

 private:
  void take(std::string_view channel, std::span<const std::byte> data);
  void follow_image();
  void send(Time now);
  void keep_own_outputs(command_t& command) const;
  void count_on(command_t& command);
  std::int64_t next_position(AxisControl::Index axis, std::int64_t from);
  void find_offsets();
  void shift(AxisControl::Index axis, command_t& command) const;
  void push(AxisControl::Index axis, command_t& command);
  static void put_shared(AxisSignals::Position target, AxisSignals::Position offset,
                         std::int64_t value, command_t& command);
  bool has_push(AxisControl::Index axis) const;
  void judge_hearing(Time now);
  void take_turns(Time now);
  void leave_motions(command_t& command, Time now);
  bool has_to_command(Time now) const;
  void send_motion(const command_t& command, Time now);

  const BusPlan& plan_;
  ApplicationOptions options_;
  sim::Random random_;
  VirtualEndpoint& lcm_;
  Channels channels_;
  bool running_ = false;
  Time stalled_until_{};
  Time reaction_{};
  Time slowness_{};
  std::int64_t instance_ = 0;
  std::uint32_t time_to_live_ = 20;
  ImageInput input_;
  AxisControl axes_;
  bool new_layout_ = false;
  bool fresh_ = false;
  Time sync_{};  // SYNC time of the newest image
  struct Course {
    std::optional<std::int64_t> position;  // last commanded one; empty while not enabled
    bool down = false;
    std::int64_t push = 0;   // target torque; the target velocity is a multiple of it
    bool weaker = false;     // `push` decreases
    std::int64_t apart = 0;  // counts by which target velocity and torque have jumped
    std::int64_t shift = 0;  // position offset
  };
  std::vector<Course> courses_;                      // one for each axis
  std::vector<std::optional<SignalIndex>> offsets_;  // position offset of each axis, if it has one
  std::int64_t jump_ = 0;                            // jump of the next command, in counts
  std::uint64_t images_ = 0;                         // images used
  bool hears_ = false;                               // an image came in this round
  std::uint64_t heard_ = 0;  // rounds with images since the last usable image
  Time heard_since_{};
  std::uint64_t sent_ = 0;

  /// The part that the program has in the motions of its axes.
  enum class Turn : std::uint8_t {
    set_points,
    motions,
    leaving,  ///< the motions stop, and set-points follow
  };
  MotionCommander commander_;
  Turn turn_ = Turn::set_points;
  Time turn_ends_{};
  Time turn_began_{};
  bool terse_ = false;  ///< it sends no commands of outputs while its axes are enabled
  std::uint64_t motions_ = 0;
  std::vector<std::byte> buffer_;
};

}  // namespace takt
