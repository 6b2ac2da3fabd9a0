#pragma once
#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <takt/motion_command_t.hpp>
#include <takt/motion_gear_t.hpp>
#include <takt/motion_t.hpp>
#include <vector>

#include "eds_parser/table/motion_axes.hpp"
#include "master/gateway/command/commands.hpp"
#include "master/gateway/motion/axis_motion_limits.hpp"
#include "master/gateway/motion/motion_answers.hpp"
#include "master/gateway/motion/motion_homing.hpp"
#include "master/gateway/motion/motion_jobs.hpp"
#include "master/gateway/motion/motion_messages.hpp"
#include "master/gateway/motion/motion_senders.hpp"
#include "master/gateway/motion/motion_sequence.hpp"
#include "master/gateway/motion/motion_stops.hpp"
#include "master/gateway/motion/motion_streams.hpp"

namespace takt {

/// Turns motion_command_t, motion_gear_t and motion_stream_t messages into orders for the bus
/// thread. The messages pass the same checks as set-points (see Commands): session, sender, age,
/// and who holds the nodes. A command takes effect for all of its axes or for none. All calls come
/// from the front thread.
class MotionCommands {
 public:
  MotionCommands(const BusPlan& plan, Commands& commands, SubmitMotion submit, NoticeSink announce);

  /// Call this in each round. If an axis has to be homed, the bus thread reads the axes from the
  /// beginning, because another program may home the axis.
  void begin() {
    if (std::ranges::any_of(axes_, &MotionAxis::needs_homing)) watch();
  }
  /// Takes a message. From the first message of this session on, the bus thread reads the axes: the
  /// target position of an axis that no program has moved follows its actual position while its
  /// drive is not enabled.
  void take(const motion_command_t& command, const CommandContext& context);
  void take(const motion_gear_t& gear, const CommandContext& context);
  void take(const motion_stream_t& stream, const CommandContext& context);
  /// Takes the newest reports, and plans the jobs that wait for them.
  void observe(const MotionSnapshot& snapshot, const CommandContext& context);
  /// Does the work that waits for time and not for reports: stops that the bus thread could not
  /// take, jobs that did not begin in time, and senders that have lost a node. Call this also right
  /// after a release, because a later sign of life of the sender would take the node again.
  void serve(const CommandContext& context);
  /// Takes a limit that was read from a drive, see AxisMotionLimits::learn().
  void learn(std::size_t line, std::int64_t value) { limits_.learn(plan_, line, value); }
  /// Takes the end of an order.
  void take(const motion::MotionEnd& end, const CommandContext& context);

  /// Returns true once the bus thread reads the axes.
  bool watches() const noexcept { return watched_; }
  /// Returns true once a sender that may hold the nodes has sent a gear, a stream, or a command
  /// other than a stop. No motion_t is sent before that.
  bool active() const noexcept { return active_; }
  /// Returns the messages about the newest reports. The caller sets `utime` and `session`.
  std::vector<motion_t> messages() const {
    return motion_messages(plan_, axes_, jobs_.snapshot(), answers_.shown());
  }

 private:
  /// The nodes that the sender of a message gets, and for how long.
  struct Claim {
    std::vector<std::size_t> nodes{};
    std::uint32_t cycles = 0;  ///< number of cycles for which the sender holds the nodes
    std::uint8_t sender = 0;   ///< number of the sender for the bus thread
  };

  std::optional<std::vector<std::size_t>> axes_of(const motion_command_t& command,
                                                  const CommandContext& context);
  std::vector<std::size_t> nodes_of(const motion_command_t& command,
                                    std::span<const std::size_t> axes,
                                    const CommandContext& context) const;
  void take_stop(const motion_command_t& command, std::span<const std::size_t> axes,
                 const CommandContext& context);
  bool is_newest(const motion_command_t& command, std::span<const std::size_t> axes,
                 const CommandContext& context);
  bool begin_stream(const motion_stream_t& stream, const motion_command_t& command,
                    std::span<const std::size_t> axes, std::uint8_t sender,
                    const CommandContext& context);
  bool has_timeout(const motion_command_t& command, const CommandContext& context);
  std::optional<Claim> claim_of(const motion_command_t& command, std::span<const std::size_t> axes,
                                const CommandContext& context);
  void hold(const motion_command_t& command, std::span<const std::size_t> axes, const Claim& claim,
            const CommandContext& context);
  void note_motion(MotionJob& job, const motion_command_t& command,
                   std::span<const std::size_t> axes, std::uint8_t sender,
                   const CommandContext& context);
  std::optional<std::uint32_t> lease_of(const motion_command_t& command,
                                        const CommandContext& context) const;
  void watch() { watched_ = watched_ || submit_({.kind = motion::MessageKind::watch}); }
  void stop(std::size_t axis);
  void tell_heard(const motion_command_t& command, std::span<const std::size_t> named,
                  std::uint8_t sender);
  void refuse(const motion_command_t& command, const MotionRefusal& refusal,
              const CommandContext& context);

  const BusPlan& plan_;
  Commands& commands_;
  SubmitMotion submit_;
  std::vector<MotionAxis> axes_;
  AxisMotionLimits limits_;
  MotionSenders senders_;
  MotionAnswers answers_;
  MotionHoming homing_;
  MotionJobs jobs_;
  MotionStops stops_;
  MotionStreams streams_;
  std::vector<MotionSequence> sequences_;  ///< indexed by axis
  bool watched_ = false;
  bool active_ = false;
};

}  // namespace takt
