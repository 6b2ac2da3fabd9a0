#include "master/gateway/motion/motion_jobs.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include "master/gateway/motion/motion_text.hpp"

namespace takt {
namespace {

/// Number of cycles from the plan of an order to its first cycle. The bus thread takes an order in
/// the next cycle, so two further cycles are enough if this thread runs in time.
constexpr motion::CycleNumber lead_cycles = 3;
constexpr unsigned most_tries = 100;  ///< also limits the wait for the first report

/// Returns true if a new plan can succeed, because the order was too late or began in another
/// state.
bool can_be_planned_again(motion::Outcome outcome) {
  return outcome == motion::Outcome::too_late || outcome == motion::Outcome::other_start ||
         outcome == motion::Outcome::second_in_cycle ||
         outcome == motion::Outcome::group_incomplete;
}

}  // namespace

MotionJobs::MotionJobs(const BusPlan& plan, const std::vector<MotionAxis>& axes,
                       const Commands& commands, MotionAnswers& answers, SubmitMotion submit)
    : axes_{axes},
      commands_{commands},
      answers_{answers},
      submit_{std::move(submit)},
      planner_{axes.size(), std::chrono::duration<double>{plan.cycle.period}.count()} {}

bool MotionJobs::prepare(MotionJob& job, const CommandContext& context) {
  if (!plan(job, context)) return false;
  drop_replaced(job);
  return true;
}

void MotionJobs::start(MotionJob job) {
  send(job);
  jobs_.push_back(std::move(job));
}

void MotionJobs::drop(std::size_t axis) {
  std::erase_if(jobs_, [&](const MotionJob& job) {
    return std::ranges::find(job.goals, axis, &motion::AxisGoal::axis) != job.goals.end();
  });
}

/// Drops the older jobs of the axes, because a newer command ends their wait. A refused command
/// does not end the wait of an older job, because the orders of that job may be on their way, see
/// take_lost().
void MotionJobs::drop_replaced(const MotionJob& job) {
  for (const motion::AxisGoal& goal : job.goals) drop(goal.axis);
}

bool MotionJobs::prepare_stream(MotionJob& job, const CommandContext& context) {
  const auto orders = planner_.begin_stream(job.group, job.goals, next_begin(context));
  if (!orders) {
    refuse_plan(job, orders.error(), context);
    return false;
  }
  drop_replaced(job);
  take_orders(job, *orders);
  job.tries = most_tries;
  return true;
}

motion::CycleNumber MotionJobs::next_begin(const CommandContext& context) const noexcept {
  const std::uint64_t since = context.cycle - std::min(context.cycle, snapshot_.cycle);
  return planner_.cycle() + since + lead_cycles;
}

/// Plans a job. Returns false if the job is refused. The job has no orders if it has to wait for
/// the next report.
bool MotionJobs::plan(MotionJob& job, const CommandContext& context) {
  const motion::CycleNumber begin = next_begin(context);
  const auto orders = job.gears.empty()
                          ? planner_.plan(job.group, job.goals, begin)
                          : planner_.begin_gear(job.group, job.goals, job.gears, begin);
  if (orders) {
    take_orders(job, *orders);
    return true;
  }
  const motion::PlanFault fault = orders.error().fault;
  if (fault == motion::PlanFault::geared) release_gears(job);
  const bool waits = fault == motion::PlanFault::no_report || fault == motion::PlanFault::busy ||
                     fault == motion::PlanFault::geared;
  if (waits && ++job.tries < most_tries) return true;
  refuse_plan(job, orders.error(), context);
  return false;
}

/// Ends the gears of the axes before the motion begins, because a motion can only be planned from a
/// state that is known in advance.
void MotionJobs::release_gears(const MotionJob& job) {
  for (const motion::AxisGoal& goal : job.goals) {
    submit_({.kind = motion::MessageKind::release, .axis = goal.axis});
  }
}

void MotionJobs::take_orders(MotionJob& job, std::span<const motion::MotionOrder> orders) {
  job.orders.assign(orders.begin(), orders.end());
  job.order = orders.front().id;
  job.begin = orders.front().begin;
  ++job.tries;
}

void MotionJobs::refuse_plan(const MotionJob& job, const motion::PlanRefusal& refusal,
                             const CommandContext& context) {
  const bool of_axis = refusal.fault != motion::PlanFault::no_report;
  answers_.refuse(job,
                  {.why = std::string{text(refusal)},
                   .axis = of_axis ? std::optional<std::size_t>{refusal.axis} : std::nullopt},
                  context);
}

void MotionJobs::send(MotionJob& job) {
  for (const motion::MotionOrder& order : job.orders) {
    submit_({.kind = motion::MessageKind::order, .order = order});
  }
  job.orders.clear();
}

/// Plans a job that waits, and sends its orders. Returns false if the job is refused.
bool MotionJobs::plan_again(MotionJob& job, const CommandContext& context) {
  if (!plan(job, context)) return false;
  send(job);
  return true;
}

void MotionJobs::observe(const MotionSnapshot& snapshot, const CommandContext& context) {
  snapshot_ = snapshot;
  planner_.observe(snapshot.cycle, snapshot.axes);
  std::erase_if(jobs_, [&](const MotionJob& job) {
    return job.order != 0 && snapshot.axes[job.goals.front().axis].running == job.order;
  });
  std::erase_if(jobs_, [&](MotionJob& job) { return job.order == 0 && !plan_again(job, context); });
}

bool MotionJobs::holds(const MotionJob& job, const CommandContext& context) const {
  return std::ranges::all_of(job.goals, [&](const motion::AxisGoal& goal) {
    return commands_.holds(axes_[goal.axis].node_index, job.instance, context.cycle);
  });
}

/// Returns true if the orders of the job may still begin. Orders that were sent can't be called
/// back: the bus thread decides whether they begin, and knows whether their sender is silent. An
/// order that the bus thread could not take gets no answer, so the wait is limited.
bool MotionJobs::has_begin_ahead(const MotionJob& job, const CommandContext& context) {
  return job.order != 0 && context.cycle <= job.begin + lead_cycles;
}

std::optional<MotionJob> MotionJobs::take_lost(const CommandContext& context) {
  const auto lost =
      std::ranges::find_if(jobs_, [&](const MotionJob& job) { return !holds(job, context); });
  if (lost == jobs_.end()) return std::nullopt;
  MotionJob job = std::move(*lost);
  jobs_.erase(lost);
  return job;
}

void MotionJobs::expire(const CommandContext& context) {
  std::erase_if(jobs_, [&](const MotionJob& job) {
    if (context.now <= job.until || has_begin_ahead(job, context)) return false;
    answers_.refuse(job, {.why = "it did not begin in time"}, context);
    return true;
  });
}

void MotionJobs::on_refused(const motion::MotionEnd& end, const CommandContext& context) {
  const auto job = std::ranges::find(jobs_, end.order.id, &MotionJob::order);
  if (job == jobs_.end()) return;
  job->order = 0;
  if (can_be_planned_again(end.order.outcome) && job->tries < most_tries) return;
  answers_.refuse(*job, {.why = std::string{text(end.order.outcome)}, .axis = end.axis}, context);
  jobs_.erase(job);
}

}  // namespace takt
