#include "master/gateway/motion/motion_commands.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <string_view>
#include <utility>

#include "master/gateway/motion/motion_text.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;

constexpr Time default_motion_timeout = std::chrono::milliseconds{500};
/// The bus thread takes an order in the next cycle, so two cycles more are enough if this thread is
/// in time.
constexpr motion::CycleNumber lead_cycles = 3;
constexpr unsigned most_tries = 100;  ///< also limits the wait for the first report

std::optional<motion::Synchronisation> synchronisation_of(const std::string& name) {
  if (name.empty() || name == "time") return motion::Synchronisation::time;
  if (name == "phase") return motion::Synchronisation::phase;
  if (name == "none") return motion::Synchronisation::none;
  return std::nullopt;
}

/// The fields that a motion has in common with a command of outputs.
command_t header_of(const motion_command_t& command) {
  command_t header{};
  header.schema = command.schema;
  header.session = command.session;
  header.instance = command.instance;
  header.sender = command.sender;
  header.cycle = command.cycle;
  return header;
}

std::uint64_t cycles_in(Time span, Time period) {
  return period <= Time{0} ? 1 : static_cast<std::uint64_t>((span + period - Time{1}) / period);
}

bool is_timeout(std::int32_t milliseconds) {
  return milliseconds >= 0 && milliseconds <= MotionSenders::longest_timeout / 1ms;
}

/// A stop with a timeout that is refused elsewhere counts as one without.
Time timeout_of(const motion_command_t& command) {
  const bool given = command.timeout_ms != 0 && is_timeout(command.timeout_ms);
  return given ? std::chrono::milliseconds{command.timeout_ms} : default_motion_timeout;
}

/// The order was planned too late or from another state: a new plan can succeed.
bool can_be_planned_again(motion::Outcome outcome) {
  return outcome == motion::Outcome::too_late || outcome == motion::Outcome::other_start ||
         outcome == motion::Outcome::second_in_cycle ||
         outcome == motion::Outcome::group_incomplete;
}

}  // namespace

MotionCommands::MotionCommands(const BusPlan& plan, Commands& commands, SubmitMotion submit,
                               NoticeSink announce)
    : plan_{plan},
      commands_{commands},
      submit_{std::move(submit)},
      announce_{std::move(announce)},
      axes_{motion_axes(plan)},
      limits_{plan},
      planner_{axes_.size(), std::chrono::duration<double>{plan.cycle.period}.count()},
      shown_(axes_.size()),
      owners_(axes_.size()),
      stops_(axes_.size()),
      sequences_(axes_.size()) {}

std::string MotionCommands::name_of(std::size_t axis) const {
  const std::string& node = plan_.nodes[axes_[axis].node_index].name;
  return axes_[axis].number == 0 ? node : fmt::format("{} (axis {})", node, axes_[axis].number + 1);
}

void MotionCommands::announce(const std::string& kind, const std::string& text,
                              std::optional<std::size_t> axis, const CommandContext& context) {
  const auto kept_back = reported_.allow(kind + text, context.now);
  if (!kept_back) return;
  announce_({.when = context.now,
             .cycle = context.cycle,
             .node = axis ? plan_.nodes[axes_[*axis].node_index].id.value() : std::uint8_t{0},
             .kind = kind,
             .weight = Weight::warning,
             .text = with_kept_back(axis ? fmt::format("{}: {}", name_of(*axis), text) : text,
                                    *kept_back)});
}

void MotionCommands::refuse(const Job& job, const Refusal& refusal, const CommandContext& context) {
  for (const motion::AxisGoal& goal : job.goals) {
    note_end(goal.axis, job.id, ShownMotion::Ended::refused);
  }
  announce("motion_refused",
           fmt::format("motion {} of '{}' refused: {}", job.id, job.sender, refusal.why),
           refusal.axis, context);
}

void MotionCommands::note_end(std::size_t axis, std::int32_t id, ShownMotion::Ended ended) {
  shown_[axis].ended_id = id;
  shown_[axis].ended = ended;
}

/// Returns the positions of the goals' axes. Empty if one of them is unknown; a stop is for the
/// others then.
std::optional<std::vector<std::size_t>> MotionCommands::axes_of(const motion_command_t& command,
                                                                const CommandContext& context) {
  const bool is_stop = command.kind == "stop";
  std::vector<std::size_t> found;
  for (const motion_goal_t& goal : command.goals) {
    const int number = std::max<int>(goal.axis, 1) - 1;
    const auto axis = std::ranges::find_if(axes_, [&](const MotionAxis& known) {
      return plan_.nodes[known.node_index].name == goal.node && known.number == number;
    });
    if (axis == axes_.end()) {
      refuse({.id = command.id, .sender = command.sender},
             {.why = fmt::format("'{:.64}' has no axis {} that taktd can move: it needs 6041 and "
                                 "6064 in TPDOs, 607A in the unit of 6064 in an RPDO, and "
                                 "`profile: cia402`",
                                 goal.node, number + 1)},
             context);
      if (is_stop) continue;
      return std::nullopt;
    }
    const auto place = static_cast<std::size_t>(axis - axes_.begin());
    if (std::ranges::find(found, place) != found.end()) {
      if (is_stop) continue;
      refuse({.id = command.id, .sender = command.sender},
             {.why = "an axis is named twice", .axis = place}, context);
      return std::nullopt;
    }
    found.push_back(place);
  }
  return found;
}

/// The nodes of the axes. A sign of life without goals is for all nodes that the sender holds and
/// that are ready.
std::vector<std::size_t> MotionCommands::nodes_of(const motion_command_t& command,
                                                  std::span<const std::size_t> axes,
                                                  const CommandContext& context) const {
  std::vector<std::size_t> nodes;
  const auto add = [&](std::size_t node) {
    if (std::ranges::find(nodes, node) == nodes.end()) nodes.push_back(node);
  };
  for (const std::size_t axis : axes) add(axes_[axis].node_index);
  if (!axes.empty() || command.kind != "alive") return nodes;
  for (const MotionAxis& axis : axes_) {
    const std::size_t node = axis.node_index;
    const bool boots = plan_.nodes[node].boot && context.nodes[node].boot != BootState::ready;
    const bool held = commands_.holds(node, command.instance, context.cycle);
    if (held && !boots && context.nodes[node].nmt == NmtState::operational) add(node);
  }
  return nodes;
}

void MotionCommands::take(const motion_command_t& command, const CommandContext& context) {
  const command_t header = header_of(command);
  if (!commands_.admits(header, context)) return;
  const auto axes = axes_of(command, context);
  if (!axes) return;
  const bool known = command.kind == "move" || command.kind == "jog" || command.kind == "stop" ||
                     command.kind == "alive";
  if (!known || (axes->empty() && command.kind != "alive")) {
    return refuse({.id = command.id, .sender = command.sender},
                  {.why = known ? "it names no axis"
                                : "its kind is none of \"move\", \"jog\", \"stop\", \"alive\""},
                  context);
  }
  if (command.kind == "stop") return take_stop(command, *axes, context);
  if (!is_timeout(command.timeout_ms)) {
    return refuse({.id = command.id, .sender = command.sender},
                  {.why = fmt::format("its timeout of {} ms is not one of 0 to 10,000 ms",
                                      command.timeout_ms)},
                  context);
  }
  if (!is_newest(command, *axes, context)) return;
  const auto lease = static_cast<std::uint32_t>(cycles_in(timeout_of(command), plan_.cycle.period));
  const std::vector<std::size_t> nodes = nodes_of(command, *axes, context);
  if (nodes.empty() || !commands_.lease(header, nodes, lease, context)) return;
  const auto sender = senders_.number_of(command.instance, context.now);
  if (sender) {
    submit_({.kind = motion::MessageKind::heard,
             .sender = *sender,
             .cycle = static_cast<motion::CycleNumber>(command.cycle)});
  }
  if (!sender) {
    return refuse({.id = command.id, .sender = command.sender},
                  {.why = "too many programs command motions"}, context);
  }
  active_ = true;
  if (command.kind != "alive") begin(command, *axes, *sender, context);
}

/// Each axis stops whose node its sender holds, whatever the other nodes are.
void MotionCommands::take_stop(const motion_command_t& command, std::span<const std::size_t> axes,
                               const CommandContext& context) {
  const command_t header = header_of(command);
  bool any = false;
  for (const std::size_t axis : axes) {
    if (!commands_.admits_stop(header, axes_[axis].node_index, context)) continue;
    sequences_[axis].stopped(command);
    stop(axis);
    any = true;
  }
  const auto sender = any ? senders_.number_of(command.instance, context.now) : std::nullopt;
  if (!sender) return;
  commands_.renew(header, nodes_of(command, axes, context),
                  static_cast<std::uint32_t>(cycles_in(timeout_of(command), plan_.cycle.period)),
                  context);
  submit_({.kind = motion::MessageKind::heard,
           .sender = *sender,
           .cycle = static_cast<motion::CycleNumber>(command.cycle)});
}

/// A move or jog that a later message has overtaken is refused, and so is a copy from before a
/// stop.
bool MotionCommands::is_newest(const motion_command_t& command, std::span<const std::size_t> axes,
                               const CommandContext& context) {
  if (command.kind != "move" && command.kind != "jog") return true;
  for (const std::size_t axis : axes) {
    const std::string_view why =
        sequences_[axis].objection(command, static_cast<std::int64_t>(context.cycle));
    if (why.empty()) continue;
    refuse({.id = command.id, .sender = command.sender}, {.why = std::string{why}, .axis = axis},
           context);
    return false;
  }
  return true;
}

/// A stop is never lost: if the bus thread can't take it now, serve() tries again.
void MotionCommands::stop(std::size_t axis) {
  std::erase_if(jobs_, [&](const Job& job) {
    return std::ranges::find(job.goals, axis, &motion::AxisGoal::axis) != job.goals.end();
  });
  stops_[axis] =
      !submit_({.kind = motion::MessageKind::stop, .axis = static_cast<std::uint8_t>(axis)});
}

void MotionCommands::begin(const motion_command_t& command, std::span<const std::size_t> axes,
                           std::uint8_t sender, const CommandContext& context) {
  Job job{.id = command.id,
          .sender = command.sender,
          .instance = command.instance,
          .until = context.now + timeout_of(command)};
  const auto synchronisation = synchronisation_of(command.synchronisation);
  if (!synchronisation) {
    return refuse(job, {.why = "its synchronisation is none of \"time\", \"phase\", \"none\""},
                  context);
  }
  job.group = {.goal = command.kind == "jog" ? motion::Goal::velocity : motion::Goal::position,
               .synchronisation = *synchronisation,
               .sender = sender,
               .timeout = cycles_in(timeout_of(command), plan_.cycle.period),
               .tag = {command.id, command.instance}};
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const motion_goal_t& goal = command.goals[i];
    const auto limits = limits_.of(axes[i], goal);
    if (!limits) return refuse(job, {.why = limits.error(), .axis = axes[i]}, context);
    const double wanted = command.kind == "jog" ? goal.velocity : goal.position;
    if (!(std::abs(wanted) <= AxisMotionLimits::largest)) {
      return refuse(job,
                    {.why = fmt::format("its target {} is infinite, NaN or too large", wanted),
                     .axis = axes[i]},
                    context);
    }
    if (!(goal.max_following_error >= 0.0)) {
      return refuse(job, {.why = "max_following_error is negative or NaN", .axis = axes[i]},
                    context);
    }
    const bool is_jog = job.group.goal == motion::Goal::velocity;
    job.goals.push_back(
        {.axis = static_cast<std::uint8_t>(axes[i]),
         .to = {.position = is_jog ? 0.0 : goal.position, .velocity = is_jog ? goal.velocity : 0.0},
         .limits = *limits,
         .range = limits_.range(axes[i]),
         .max_following_error = goal.max_following_error > 0.0
                                    ? goal.max_following_error
                                    : std::numeric_limits<double>::infinity()});
  }
  for (const std::size_t axis : axes) sequences_[axis].moved(command);
  drop_replaced(job);
  if (!plan(job, context)) jobs_.push_back(std::move(job));
}

/// A newer command of an axis ends the wait of an older one.
void MotionCommands::drop_replaced(const Job& job) {
  std::erase_if(jobs_, [&](const Job& older) {
    return std::ranges::any_of(older.goals, [&](const motion::AxisGoal& goal) {
      return std::ranges::find(job.goals, goal.axis, &motion::AxisGoal::axis) != job.goals.end();
    });
  });
}

/// Plans the job and sends its orders. Returns false if it has to wait for the next report, or for
/// the bus thread's answer.
bool MotionCommands::plan(Job& job, const CommandContext& context) {
  if (!holds(job, context)) {
    refuse(job, {.why = "its sender does not hold the nodes any longer"}, context);
    return true;
  }
  const std::uint64_t since = context.cycle - std::min(context.cycle, snapshot_.cycle);
  const auto orders = planner_.plan(job.group, job.goals, planner_.cycle() + since + lead_cycles);
  if (!orders) {
    const motion::PlanRefusal& refusal = orders.error();
    const bool waits =
        refusal.fault == motion::PlanFault::no_report || refusal.fault == motion::PlanFault::busy;
    if (waits && ++job.tries < most_tries) return false;
    const bool of_axis = refusal.fault != motion::PlanFault::no_report;
    refuse(job,
           {.why = std::string{text(refusal)},
            .axis = of_axis ? std::optional<std::size_t>{refusal.axis} : std::nullopt},
           context);
    return true;
  }
  job.order = orders->front().id;
  job.begin = orders->front().begin;
  ++job.tries;
  for (const motion::MotionOrder& order : *orders) {
    submit_({.kind = motion::MessageKind::order, .order = order});
  }
  return false;
}

void MotionCommands::observe(const MotionSnapshot& snapshot, const CommandContext& context) {
  if (snapshot.cycle == 0) return;
  snapshot_ = snapshot;
  planner_.observe(snapshot.cycle, snapshot.axes);
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    const motion::TaggedOrder* running = planner_.order(i, snapshot.axes[i].running);
    shown_[i].id = running == nullptr ? 0 : running->tag.id;
    if (running != nullptr) owners_[i] = {running->tag.instance, running->order.sender};
  }
  std::erase_if(jobs_, [&](const Job& job) {
    return job.order != 0 && snapshot.axes[job.goals.front().axis].running == job.order;
  });
  for (std::size_t i = 0; i < jobs_.size();) {
    const bool ended = jobs_[i].order == 0 && plan(jobs_[i], context);
    if (ended) {
      jobs_.erase(jobs_.begin() + static_cast<std::ptrdiff_t>(i));
    } else {
      ++i;
    }
  }
}

bool MotionCommands::holds(const Job& job, const CommandContext& context) const {
  return std::ranges::all_of(job.goals, [&](const motion::AxisGoal& goal) {
    return commands_.holds(axes_[goal.axis].node_index, job.instance, context.cycle);
  });
}

/// Orders on their way can't be called back, so the bus thread decides whether they begin. It also
/// knows whether their sender is silent. An order that the bus thread could not take has no answer.
bool MotionCommands::has_begin_ahead(const Job& job, const CommandContext& context) {
  return job.order != 0 && context.cycle <= job.begin + lead_cycles;
}

/// Orders on their way whose sender has lost a node meanwhile must not begin.
void MotionCommands::stop_lost(const CommandContext& context) {
  const auto is_lost = [&](const Job& job) { return job.order != 0 && !holds(job, context); };
  for (auto lost = std::ranges::find_if(jobs_, is_lost); lost != jobs_.end();
       lost = std::ranges::find_if(jobs_, is_lost)) {
    const Job job = std::move(*lost);
    jobs_.erase(lost);
    refuse(job, {.why = "its sender does not hold the nodes any longer"}, context);
    for (const motion::AxisGoal& goal : job.goals) stop(goal.axis);
  }
}

void MotionCommands::serve(const CommandContext& context) {
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    if (stops_[i]) stop(i);
    const bool lost = owners_[i].instance != 0 &&
                      !commands_.holds(axes_[i].node_index, owners_[i].instance, context.cycle);
    if (lost && submit_({.kind = motion::MessageKind::left,
                         .sender = owners_[i].number,
                         .axis = static_cast<std::uint8_t>(i)})) {
      owners_[i] = {};
    }
  }
  stop_lost(context);
  std::erase_if(jobs_, [&](const Job& job) {
    if (context.now <= job.until || has_begin_ahead(job, context)) return false;
    refuse(job, {.why = "it did not begin in time"}, context);
    return true;
  });
}

void MotionCommands::take(const motion::MotionEnd& end, const CommandContext& context) {
  if (end.axis >= axes_.size()) return;
  const motion::TaggedOrder* order = planner_.order(end.axis, end.order.id);
  const std::int32_t id = order == nullptr ? 0 : order->tag.id;
  switch (end.order.outcome) {
    case motion::Outcome::done:
      note_end(end.axis, id, ShownMotion::Ended::done);
      break;
    case motion::Outcome::replaced:
      note_end(end.axis, id, ShownMotion::Ended::replaced);
      break;
    case motion::Outcome::stopped:
      note_end(end.axis, id, ShownMotion::Ended::stopped);
      announce("motion_stopped",
               fmt::format("motion {} has stopped because of {}: {}", id,
                           name_of(std::min<std::size_t>(end.stop.axis, axes_.size() - 1)),
                           text(end.stop.cause)),
               end.axis, context);
      break;
    default:
      return on_refused(end, context);
  }
  std::erase_if(jobs_, [&](const Job& job) { return job.order == end.order.id; });
}

/// The bus thread has refused an order. All orders of its group are refused then.
void MotionCommands::on_refused(const motion::MotionEnd& end, const CommandContext& context) {
  const auto job = std::ranges::find(jobs_, end.order.id, &Job::order);
  if (job == jobs_.end()) return;
  job->order = 0;
  if (can_be_planned_again(end.order.outcome) && job->tries < most_tries) return;
  refuse(*job, {.why = std::string{text(end.order.outcome)}, .axis = end.axis}, context);
  jobs_.erase(job);
}

}  // namespace takt
