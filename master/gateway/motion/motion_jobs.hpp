#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "eds_parser/table/motion_axes.hpp"
#include "master/gateway/command/commands.hpp"
#include "master/gateway/motion/motion_answers.hpp"
#include "master/gateway/motion/motion_job.hpp"
#include "master/rt/exchange/motion_board.hpp"

namespace takt {

/// Hands moves, jogs, gears and the starts of streams to the bus thread. It plans them, and plans
/// them again if their orders came too late. All calls come from the front thread.
class MotionJobs {
 public:
  /// Keeps references to the arguments except the last one. `axes` are the motion_axes() of the
  /// plan.
  MotionJobs(const BusPlan& plan, const std::vector<MotionAxis>& axes, const Commands& commands,
             MotionAnswers& answers, SubmitMotion submit);

  /// Plans a new job, which replaces older jobs of its axes. Returns false if the job is refused.
  bool prepare(MotionJob& job, const CommandContext& context);
  /// Plans a job that begins a stream. The job is planned only once, because its points count from
  /// its first cycle. Returns false if the job is refused.
  bool prepare_stream(MotionJob& job, const CommandContext& context);
  /// Sends the orders of a job that was prepared, or lets it wait for the next report.
  void start(MotionJob job);
  /// Forgets the job of the axis, because a stop replaces it.
  void drop(std::size_t axis);
  /// Takes the newest reports, and plans the jobs that wait for them. Call take_lost() first.
  void observe(const MotionSnapshot& snapshot, const CommandContext& context);
  /// Notes that the bus thread has refused an order. It then refuses all orders of the group.
  void on_refused(const motion::MotionEnd& end, const CommandContext& context);
  /// Notes that an order has begun and ended.
  void on_ended(std::uint32_t order) {
    std::erase_if(jobs_, [&](const MotionJob& job) { return job.order == order; });
  }
  /// Removes and returns a job whose sender has lost a node since. The job must not begin, and its
  /// orders may be on their way. Returns std::nullopt if there is no such job.
  std::optional<MotionJob> take_lost(const CommandContext& context);
  /// Refuses the jobs that did not begin in time.
  void expire(const CommandContext& context);

  /// Returns the order of the axis with this id, or nullptr if it is unknown, see
  /// MotionPlanner::order().
  const motion::TaggedOrder* order(std::size_t axis, std::uint32_t id) const noexcept {
    return planner_.order(axis, id);
  }
  const MotionSnapshot& snapshot() const noexcept { return snapshot_; }

 private:
  motion::CycleNumber next_begin(const CommandContext& context) const noexcept;
  bool plan(MotionJob& job, const CommandContext& context);
  void release_gears(const MotionJob& job);
  void take_orders(MotionJob& job, std::span<const motion::MotionOrder> orders);
  void refuse_plan(const MotionJob& job, const motion::PlanRefusal& refusal,
                   const CommandContext& context);
  void send(MotionJob& job);
  bool plan_again(MotionJob& job, const CommandContext& context);
  bool holds(const MotionJob& job, const CommandContext& context) const;
  static bool has_begin_ahead(const MotionJob& job, const CommandContext& context);
  void drop_replaced(const MotionJob& job);

  const std::vector<MotionAxis>& axes_;
  const Commands& commands_;
  MotionAnswers& answers_;
  SubmitMotion submit_;
  motion::MotionPlanner planner_;
  MotionSnapshot snapshot_;
  std::vector<MotionJob> jobs_;  ///< at most one for each axis
};

}  // namespace takt
