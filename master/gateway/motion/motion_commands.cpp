#include "master/gateway/motion/motion_commands.hpp"

#include <algorithm>
#include <chrono>
#include <fmt/format.h>
#include <string_view>
#include <utility>

#include "master/gateway/motion/gear_jobs.hpp"
#include "master/gateway/motion/motion_goals.hpp"

namespace takt {
namespace {

/// Returns the fields that a motion has in common with a command of outputs.
command_t header_of(const motion_command_t& command) {
  command_t header{};
  header.schema = command.schema;
  header.session = command.session;
  header.instance = command.instance;
  header.sender = command.sender;
  header.cycle = command.cycle;
  return header;
}

/// Returns true if the message commands a motion, and is neither a stop nor a sign of life.
bool is_motion(const motion_command_t& command) {
  return command.kind == "move" || command.kind == "move_by" || command.kind == "jog";
}

MotionName motion_name(const motion_command_t& command) {
  return {.id = command.id, .sender = command.sender};
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
      homing_{axes_, answers_},
      jobs_{plan, axes_, commands, answers_, submit_},
      stops_{axes_, commands, submit_},
      streams_{std::chrono::duration<double>{plan.cycle.period}.count(), submit_},
      sequences_(axes_.size()) {}

void MotionCommands::refuse(const motion_command_t& command, const MotionRefusal& refusal,
                            const CommandContext& context) {
  answers_.refuse(motion_name(command), {}, refusal, context);
}

/// Reports to the bus thread that the sender is alive. A jog goes on only while its sender names
/// its axes, so the message names them too.
void MotionCommands::tell_heard(const motion_command_t& command, std::span<const std::size_t> named,
                                std::uint8_t sender) {
  const auto cycle = static_cast<motion::CycleNumber>(command.cycle);
  submit_({.kind = motion::MessageKind::heard, .sender = sender, .cycle = cycle});
  if (command.kind != "jog" && command.kind != "alive") return;
  for (const std::size_t axis : named) {
    submit_({.kind = motion::MessageKind::renew,
             .sender = sender,
             .cycle = cycle,
             .axis = static_cast<std::uint8_t>(axis)});
  }
}

/// Returns the axes of the goals, as indices into motion_axes(). Returns std::nullopt if an axis is
/// unknown or named twice. A stop skips such goals and stops the other axes.
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
                                 "6064 in TPDOs, 607A with the unit, scale and offset of 6064 in "
                                 "an RPDO, no 60B0 in an RPDO, and `profile: cia402`",
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

/// Returns the nodes of the axes. A message of the kind "alive" without axes concerns all nodes
/// that the sender holds and that are ready.
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
  if (!commands_.admits(header_of(command), context)) return;
  watch();
  const auto axes = axes_of(command, context);
  if (!axes) return;
  const bool known = is_motion(command) || command.kind == "stop" || command.kind == "alive";
  if (!known || (axes->empty() && command.kind != "alive")) {
    return refuse(
        command,
        {.why = known
                    ? "it names no axis"
                    : "its kind is not one of \"move\", \"move_by\", \"jog\", \"stop\", \"alive\""},
        context);
  }
  if (command.kind == "stop") return take_stop(command, *axes, context);
  if (!has_timeout(command, context) || !is_newest(command, *axes, context)) return;
  std::optional<MotionJob> job;
  if (command.kind == "move") {
    const auto objection = homing_.objection(*axes);
    if (objection) return answers_.refuse(motion_name(command), *axes, *objection, context);
  }
  if (is_motion(command)) {
    auto made = motion_job(command, *axes, limits_, plan_.cycle.period);
    if (!made) return answers_.refuse(motion_name(command), *axes, made.error(), context);
    job = std::move(*made);
  }
  const auto claim = claim_of(command, *axes, context);
  if (!claim) return;
  active_ = true;
  if (job) {
    note_motion(*job, command, *axes, claim->sender, context);
    if (!jobs_.prepare(*job, context)) return;
  }
  hold(command, *axes, *claim, context);
  if (job) jobs_.start(std::move(*job));
}

void MotionCommands::take(const motion_gear_t& gear, const CommandContext& context) {
  const motion_command_t command = command_of(gear);
  if (!commands_.admits(header_of(command), context)) return;
  watch();
  const auto axes = axes_of(command, context);
  if (!axes) return;
  if (axes->empty()) return refuse(command, {.why = "it names no axis"}, context);
  if (!has_timeout(command, context) || !is_newest(command, *axes, context)) return;
  auto job = motion_job(command, *axes, limits_, plan_.cycle.period);
  if (!job) return answers_.refuse(motion_name(command), *axes, job.error(), context);
  auto tasks = gear_tasks(gear, *axes, {plan_, axes_, limits_});
  if (!tasks) return answers_.refuse(motion_name(command), *axes, tasks.error(), context);
  const auto objection = gear.phase == "at" ? homing_.objection(*axes) : std::nullopt;
  if (objection) return answers_.refuse(motion_name(command), *axes, *objection, context);
  job->gears = std::move(*tasks);
  const auto claim = claim_of(command, *axes, context);
  if (!claim) return;
  active_ = true;
  note_motion(*job, command, *axes, claim->sender, context);
  if (!jobs_.prepare(*job, context)) return;
  hold(command, *axes, *claim, context);
  jobs_.start(std::move(*job));
}

void MotionCommands::take(const motion_stream_t& stream, const CommandContext& context) {
  const motion_command_t command = command_of(stream);
  if (!commands_.admits(header_of(command), context)) return;
  watch();
  const auto axes = axes_of(command, context);
  if (!axes) return;
  if (axes->empty()) return refuse(command, {.why = "it names no axis"}, context);
  if (!has_timeout(command, context) || !is_newest(command, *axes, context)) return;
  const bool runs = streams_.runs(command.instance, command.id);
  if (!runs && (stream.first_point != 0 || stream.points.empty())) {
    return refuse(command, {.why = "its stream does not run, and a new one begins with point 0"},
                  context);
  }
  if (runs && !streams_.has_axes(command.instance, command.id, *axes)) {
    return refuse(command, {.why = "its axes are not those of its first message"}, context);
  }
  const auto is_over = [&](std::size_t axis) { return sequences_[axis].has_streamed(command); };
  if (!runs && std::ranges::any_of(*axes, is_over)) {
    return refuse(command, {.why = "the stream with its id is over: a new one needs a new id"},
                  context);
  }
  const auto claim = claim_of(command, *axes, context);
  if (!claim) return;
  active_ = true;
  if (!runs && !begin_stream(stream, command, *axes, claim->sender, context)) return;
  hold(command, *axes, *claim, context);
  const auto refused = streams_.add(stream, context.cycle, jobs_.snapshot().cycle);
  if (refused) refuse(command, *refused, context);
}

/// Sends the orders of a stream, before its points. Returns false if the stream is refused.
bool MotionCommands::begin_stream(const motion_stream_t& stream, const motion_command_t& command,
                                  std::span<const std::size_t> axes, std::uint8_t sender,
                                  const CommandContext& context) {
  auto job = stream_job(stream, command, axes, limits_, plan_.cycle.period);
  const auto objection = homing_.objection(axes);
  if (!job || objection) {
    answers_.refuse(motion_name(command), axes, job ? *objection : job.error(), context);
    return false;
  }
  note_motion(*job, command, axes, sender, context);
  if (!jobs_.prepare_stream(*job, context)) return false;
  for (const std::size_t axis : axes) sequences_[axis].streamed(command);
  streams_.begin(*job, stream.points.front().time);
  jobs_.start(std::move(*job));
  return true;
}

bool MotionCommands::has_timeout(const motion_command_t& command, const CommandContext& context) {
  if (is_motion_timeout(command.timeout_ms)) return true;
  refuse(command,
         {.why = fmt::format("its timeout of {} ms is outside 0 to 10,000 ms", command.timeout_ms)},
         context);
  return false;
}

/// Returns the claim of the sender if it may have the nodes of the axes. Otherwise reports the
/// refusal and returns std::nullopt.
std::optional<MotionCommands::Claim> MotionCommands::claim_of(const motion_command_t& command,
                                                              std::span<const std::size_t> axes,
                                                              const CommandContext& context) {
  Claim claim{.nodes = nodes_of(command, axes, context)};
  if (claim.nodes.empty()) return std::nullopt;
  if (!commands_.admits_lease(header_of(command), claim.nodes, context)) return std::nullopt;
  const auto lease = lease_of(command, context);
  if (!lease) {
    refuse(command, {.why = "the message is older than its timeout"}, context);
    return std::nullopt;
  }
  const auto sender = senders_.number_of(command.instance, context.now);
  if (!sender) {
    refuse(command, {.why = "too many programs command motions"}, context);
    return std::nullopt;
  }
  claim.cycles = *lease;
  claim.sender = *sender;
  return claim;
}

/// Gives the nodes to the sender, and reports to the bus thread that the sender is alive. A motion
/// that is refused takes no node, and is no sign of life.
void MotionCommands::hold(const motion_command_t& command, std::span<const std::size_t> axes,
                          const Claim& claim, const CommandContext& context) {
  const command_t header = header_of(command);
  if (command.kind == "alive") {
    commands_.renew(header, claim.nodes, claim.cycles, context);
  } else {
    commands_.lease(header, claim.nodes, claim.cycles, context);
  }
  tell_heard(command, axes, claim.sender);
}

void MotionCommands::note_motion(MotionJob& job, const motion_command_t& command,
                                 std::span<const std::size_t> axes, std::uint8_t sender,
                                 const CommandContext& context) {
  job.group.sender = sender;
  job.until = context.now + motion_timeout_of(command);
  for (const std::size_t axis : axes) sequences_[axis].moved(command);
}

/// Returns the number of cycles for which the message holds its nodes from now on. The timeout
/// counts from the cycle of the image that the sender has seen, and includes the last cycle.
/// Returns std::nullopt if the timeout is over.
std::optional<std::uint32_t> MotionCommands::lease_of(const motion_command_t& command,
                                                      const CommandContext& context) const {
  const auto seen = static_cast<std::uint64_t>(command.cycle);
  const std::uint64_t age = context.cycle - std::min(context.cycle, seen);
  const std::uint64_t whole = cycles_in(motion_timeout_of(command), plan_.cycle.period) + 1;
  if (age >= whole) return std::nullopt;
  return static_cast<std::uint32_t>(whole - age);
}

/// Stops each named axis whose node no other sender holds. The nodes of the other axes do not
/// matter.
void MotionCommands::take_stop(const motion_command_t& command, std::span<const std::size_t> axes,
                               const CommandContext& context) {
  const command_t header = header_of(command);
  bool any = false;
  for (const std::size_t axis : axes) {
    if (!commands_.admits_stop(header, axes_[axis].node_index, context)) continue;
    any = true;
    if (sequences_[axis].is_copy(command)) continue;
    sequences_[axis].stopped(command);
    stop(axis);
  }
  const auto sender = any ? senders_.number_of(command.instance, context.now) : std::nullopt;
  const auto lease = lease_of(command, context);
  if (!sender || !lease) return;
  commands_.renew(header, nodes_of(command, axes, context), *lease, context);
  tell_heard(command, {}, *sender);
}

/// Refuses a motion that a later message has overtaken, and a copy of a message from before a stop.
/// Further points of a stream that runs are refused only because of a stop: the stream continues
/// although a later motion was refused.
bool MotionCommands::is_newest(const motion_command_t& command, std::span<const std::size_t> axes,
                               const CommandContext& context) {
  const bool is_stream = command.kind == "stream";
  if (!is_motion(command) && !is_stream && command.kind != "gear") return true;
  const bool goes_on = is_stream && streams_.runs(command.instance, command.id);
  const auto now = static_cast<std::int64_t>(context.cycle);
  for (const std::size_t axis : axes) {
    const MotionSequence& sequence = sequences_[axis];
    const std::string_view why =
        goes_on ? sequence.stop_objection(command, now) : sequence.objection(command, now);
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

void MotionCommands::observe(const MotionSnapshot& snapshot, const CommandContext& context) {
  if (snapshot.cycle == 0) return;
  homing_.observe(snapshot, context);
  jobs_.observe(snapshot, context);
  streams_.observe(snapshot);
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    const motion::TaggedOrder* running = jobs_.order(i, snapshot.axes[i].running);
    answers_.runs(i, running == nullptr ? 0 : running->tag.id);
    if (running != nullptr) stops_.began(*running);
  }
}

void MotionCommands::serve(const CommandContext& context) {
  stops_.serve(context);
  streams_.serve();
  while (const auto lost = jobs_.take_lost(context)) {
    answers_.refuse(*lost, {.why = "its sender does not hold the nodes any longer"}, context);
    if (lost->order == 0) continue;
    for (const motion::AxisGoal& goal : lost->goals) stop(goal.axis);
  }
  jobs_.expire(context);
}

void MotionCommands::take(const motion::MotionEnd& end, const CommandContext& context) {
  if (end.axis >= axes_.size()) return;
  streams_.on_end(end.order.id);
  const motion::TaggedOrder* order = jobs_.order(end.axis, end.order.id);
  const std::int32_t id = order == nullptr ? 0 : order->tag.id;
  if (order != nullptr && motion::has_begun(end.order.outcome)) {
    stops_.began(*order);
  }
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
