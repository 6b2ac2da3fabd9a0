#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <takt/motion_command_t.hpp>
#include <takt/motion_t.hpp>
#include <vector>

#include "eds_parser/table/motion_axes.hpp"
#include "master/gateway/command/commands.hpp"
#include "master/gateway/motion/axis_motion_limits.hpp"
#include "master/gateway/motion/motion_messages.hpp"
#include "master/gateway/motion/motion_senders.hpp"
#include "master/gateway/motion/motion_sequence.hpp"
#include "master/gateway/notice/notice.hpp"
#include "master/lcm/rate_limit.hpp"
#include "master/motion/beat/motion_message.hpp"
#include "master/motion/planner/motion_planner.hpp"
#include "master/rt/exchange/motion_board.hpp"

namespace takt {

/// Hands a message to the bus thread. Returns false if too many wait.
using SubmitMotion = std::function<bool(const motion::MotionMessage& message)>;

/// Turns motion_command_t messages into orders for the bus thread. The checks of Commands hold for
/// them: session, sender, age, and who holds the nodes. A command takes effect for all of its axes
/// or for none. Front thread.
class MotionCommands {
 public:
  MotionCommands(const BusPlan& plan, Commands& commands, SubmitMotion submit, NoticeSink announce);

  /// Lets the bus thread read the axes from now on: the target position of an axis that nobody has
  /// moved follows its actual position while its drive is not enabled.
  void watch() { watched_ = watched_ || submit_({.kind = motion::MessageKind::watch}); }
  void take(const motion_command_t& command, const CommandContext& context);
  /// Takes the newest reports, and plans what waits for them.
  void observe(const MotionSnapshot& snapshot, const CommandContext& context);
  /// Does what waits for time and not for reports: stops that the bus thread could not take, jobs
  /// that did not begin in time, and senders that have lost a node.
  void serve(const CommandContext& context);
  /// Takes the end of an order.
  void take(const motion::MotionEnd& end, const CommandContext& context);

  /// Returns true once a command was accepted. There are no reports before.
  bool active() const noexcept { return active_; }
  /// The messages about the newest reports. The caller sets `utime` and `session`.
  std::vector<motion_t> messages() const {
    return motion_messages(plan_, axes_, snapshot_, shown_);
  }

 private:
  /// A move or a jog on its way to the bus thread.
  struct Job {
    std::int32_t id = 0;  ///< of the application
    std::string sender{};
    std::int64_t instance = 0;
    Time until{};  ///< a job is refused if it has no orders by then
    motion::GroupGoal group{};
    std::vector<motion::AxisGoal> goals{};
    unsigned tries = 0;
    std::uint32_t order = 0;        ///< id of its orders; 0 while it waits to be planned
    motion::CycleNumber begin = 0;  ///< of its orders
  };
  /// Why a command is refused, and the axis that it concerns.
  struct Refusal {
    std::string why{};
    std::optional<std::size_t> axis{};
  };
  /// A sender as the nodes and as the bus thread know it.
  struct Owner {
    std::int64_t instance = 0;  ///< 0 for none
    std::uint8_t number = 0;
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
  void begin(const motion_command_t& command, std::span<const std::size_t> axes,
             std::uint8_t sender, const CommandContext& context);
  bool plan(Job& job, const CommandContext& context);
  void stop(std::size_t axis);
  bool holds(const Job& job, const CommandContext& context) const;
  static bool has_begin_ahead(const Job& job, const CommandContext& context);
  void stop_lost(const CommandContext& context);
  void drop_replaced(const Job& job);
  void on_refused(const motion::MotionEnd& end, const CommandContext& context);
  void refuse(const Job& job, const Refusal& refusal, const CommandContext& context);
  void announce(const std::string& kind, const std::string& text, std::optional<std::size_t> axis,
                const CommandContext& context);
  std::string name_of(std::size_t axis) const;
  void note_end(std::size_t axis, std::int32_t id, ShownMotion::Ended ended);

  const BusPlan& plan_;
  Commands& commands_;
  SubmitMotion submit_;
  NoticeSink announce_;
  RateLimit reported_{std::chrono::seconds{1}};
  std::vector<MotionAxis> axes_;
  AxisMotionLimits limits_;
  MotionSenders senders_;
  motion::MotionPlanner planner_;
  MotionSnapshot snapshot_;
  std::vector<Job> jobs_;  ///< at most one for each axis
  std::vector<ShownMotion> shown_;
  std::vector<Owner> owners_;              ///< by axis: the sender of the motion that began last
  std::vector<bool> stops_;                ///< by axis: a stop has to be handed over
  std::vector<MotionSequence> sequences_;  ///< by axis
  bool watched_ = false;
  bool active_ = false;
};

}  // namespace takt
