#include "master/gateway/motion/motion_commands.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <string_view>
#include <utility>

#include "master/gateway/motion/motion_goals.hpp"

namespace takt {
namespace {

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

}  // namespace

MotionCommands::MotionCommands(const BusPlan& plan, Commands& commands, SubmitMotion submit,
                               NoticeSink announce)
    : plan_{plan},
      commands_{commands},
      submit_{std::move(submit)},
      axes_{motion_axes(plan)},
      limits_{plan},
      answers_{plan, axes_, std::move(announce)},
      jobs_{plan, axes_, commands, answers_, submit_},
      stops_{axes_, commands, submit_},
      sequences_(axes_.size()) {}

void MotionCommands::refuse(const motion_command_t& command, const MotionRefusal& refusal,
                            const CommandContext& context) {
  answers_.refuse(MotionName{.id = command.id, .sender = command.sender}, refusal, context);
}

void MotionCommands::tell_heard(const motion_command_t& command, std::uint8_t sender) {
  submit_({.kind = motion::MessageKind::heard,
           .sender = sender,
           .cycle = static_cast<motion::CycleNumber>(command.cycle)});
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
      refuse(command,
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
      refuse(command, {.why = "an axis is named twice", .axis = place}, context);
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
    return refuse(command,
                  {.why = known ? "it names no axis"
                                : "its kind is none of \"move\", \"jog\", \"stop\", \"alive\""},
                  context);
  }
  if (command.kind == "stop") return take_stop(command, *axes, context);
  if (!is_motion_timeout(command.timeout_ms)) {
    return refuse(command,
                  {.why = fmt::format("its timeout of {} ms is not one of 0 to 10,000 ms",
                                      command.timeout_ms)},
                  context);
  }
  if (!is_newest(command, *axes, context)) return;
  const auto lease =
      static_cast<std::uint32_t>(cycles_in(motion_timeout_of(command), plan_.cycle.period));
  const std::vector<std::size_t> nodes = nodes_of(command, *axes, context);
  if (nodes.empty() || !commands_.lease(header, nodes, lease, context)) return;
  const auto sender = senders_.number_of(command.instance, context.now);
  if (!sender) {
    return refuse(command, {.why = "too many programs command motions"}, context);
  }
  tell_heard(command, *sender);
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
  commands_.renew(
      header, nodes_of(command, axes, context),
      static_cast<std::uint32_t>(cycles_in(motion_timeout_of(command), plan_.cycle.period)),
      context);
  tell_heard(command, *sender);
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
    refuse(command, {.why = std::string{why}, .axis = axis}, context);
    return false;
  }
  return true;
}

void MotionCommands::stop(std::size_t axis) {
  jobs_.drop(axis);
  stops_.stop(axis);
}

void MotionCommands::begin(const motion_command_t& command, std::span<const std::size_t> axes,
                           std::uint8_t sender, const CommandContext& context) {
  auto job = motion_job(command, axes, limits_, plan_.cycle.period);
  if (!job) return refuse(command, job.error(), context);
  job->group.sender = sender;
  job->until = context.now + motion_timeout_of(command);
  for (const std::size_t axis : axes) sequences_[axis].moved(command);
  jobs_.start(std::move(*job), context);
}

void MotionCommands::observe(const MotionSnapshot& snapshot, const CommandContext& context) {
  if (snapshot.cycle == 0) return;
  jobs_.observe(snapshot, context);
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    const motion::TaggedOrder* running = jobs_.order(i, snapshot.axes[i].running);
    answers_.runs(i, running == nullptr ? 0 : running->tag.id);
    if (running != nullptr) stops_.began(i, running->order.sender, running->tag.instance);
  }
}

void MotionCommands::serve(const CommandContext& context) {
  stops_.serve(context);
  while (const auto lost = jobs_.take_lost(context)) {
    answers_.refuse(*lost, {.why = "its sender does not hold the nodes any longer"}, context);
    for (const motion::AxisGoal& goal : lost->goals) stop(goal.axis);
  }
  jobs_.expire(context);
}

void MotionCommands::take(const motion::MotionEnd& end, const CommandContext& context) {
  if (end.axis >= axes_.size()) return;
  const motion::TaggedOrder* order = jobs_.order(end.axis, end.order.id);
  const std::int32_t id = order == nullptr ? 0 : order->tag.id;
  switch (end.order.outcome) {
    case motion::Outcome::done:
      answers_.ended(end.axis, id, ShownMotion::Ended::done);
      break;
    case motion::Outcome::replaced:
      answers_.ended(end.axis, id, ShownMotion::Ended::replaced);
      break;
    case motion::Outcome::stopped:
      answers_.stopped(end.axis, id, end.stop, context);
      break;
    default:
      return jobs_.on_refused(end, context);
  }
  jobs_.on_ended(end.order.id);
}

}  // namespace takt
