#include <algorithm>
#include <cstring>
#include <optional>

#include "master/core/pdo/pdo_outputs.hpp"

namespace takt {
namespace {

std::optional<std::uint32_t> value_of(std::span<const LimitReading> readings,
                                      ObjectKey object) noexcept {
  const auto found = std::ranges::find(readings, object, &LimitReading::object);
  return found == readings.end() ? std::nullopt : std::optional{found->value};
}

}  // namespace

void PdoOutputs::learn(std::size_t node_index, std::span<const LimitReading> readings,
                       OutputMoment moment) noexcept {
  std::optional<std::uint16_t> reported;
  for (const DeviceLimit& limit : plan_.limits.device) {
    if (limit.node_index != node_index) continue;
    const bool is_range = limit.bound == DeviceBound::range;
    const auto first = value_of(readings, limit.object);
    const auto last = is_range ? value_of(readings, upper_object(limit)) : first;
    if (!first || !last) continue;
    const auto verdict =
        limits_.narrow(limit, *first, *last) ? LimitVerdict::good : LimitVerdict::implausible;
    if (reported == limit.line) continue;
    reported = limit.line;
    const auto low = static_cast<std::int32_t>(*first);
    events_.push(
        {.when = moment.now,
         .cycle = moment.cycle,
         .kind = EventKind::limit_read,
         .node = plan_.nodes[node_index].id.value(),
         .detail = std::uint32_t{limit.line} << 8U | static_cast<std::uint32_t>(verdict),
         .value = is_range ? std::int64_t{low} * 0x1'0000'0000 + *last : std::int64_t{*first}});
  }
}

bool PdoOutputs::limited_row_open(std::size_t place) const noexcept {
  return rows_[plan_.layout.signals[limits_.limit(place).signal].row].open;
}

Obeying PdoOutputs::obeying(SignalIndex signal) const noexcept {
  const Output& output = outputs_[output_of(signal)];
  return output.commanded && !output.fallen ? Obeying::yes : Obeying::no;
}

/// Lets every commanded output of the node take its fallback.
void PdoOutputs::drop_node(std::size_t node_index) noexcept {
  for (std::size_t i = 0; i < outputs_.size(); ++i) {
    const auto signal = static_cast<SignalIndex>(inputs_count_ + i);
    if (plan_.layout.signals[signal].node_index != node_index) continue;
    Output& output = outputs_[i];
    if (output.commanded && !output.fallen && !output.forced) fall(output, signal);
  }
}

bool PdoOutputs::judge(std::size_t place, const AxisCommand& command, Cause cause,
                       OutputMoment moment) noexcept {
  const SignalIndex target = limits_.limit(place).signal;
  const auto found = limits_.judge(place, command, obeying(target), moment.cycle);
  if (!found) return true;
  const Signal& what = plan_.layout.signals[target];
  if (refusals_.refuse(place, moment.cycle)) {
    const std::uint32_t held = command.age == SetPointAge::held ? held_set_point : 0U;
    Event event{.when = moment.now,
                .cycle = moment.cycle,
                .kind = EventKind::limit_exceeded,
                .node = what.node.value(),
                .detail = std::uint32_t{cause.signal} << 8U | held |
                          static_cast<std::uint32_t>(found->kind),
                .value = cause.value};
    std::memcpy(event.bytes.data(), &found->measured, 4);
    std::memcpy(event.bytes.data() + 4, &found->limit, 4);
    events_.push(event);
  }
  drop_node(what.node_index);
  return false;
}

/// Ends the refusal of commands to an output, but not before the fallback of its node was sent. A
/// cycle without outputs, or an inhibit time, may delay the fallback. Until it is sent, the axis
/// still follows its old set-points, although commands would already be checked as if it did not
/// follow them.
void PdoOutputs::end_refusal(std::size_t place, OutputMoment moment) noexcept {
  const std::size_t node_index = plan_.layout.signals[limits_.limit(place).signal].node_index;
  if (!refusals_.holds(node_index)) return;
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const Row& row = rows_[i];
    const bool waits = row.open && row.ready && row.pending;
    if (waits && plan_.pdos.rpdos[i].node_index == node_index) return;
  }
  refusals_.end(place, moment.cycle);
}

/// Returns the newest value of an output in this pack: a new command, or else the value in the
/// image.
PdoOutputs::Newest PdoOutputs::newest(std::optional<SignalIndex> signal,
                                      std::span<const SetPoint> set_points,
                                      OutputMoment moment) const noexcept {
  if (!signal) return {};
  const SetPoint& set_point = set_points[output_of(*signal)];
  const bool is_new = is_new_command(outputs_[output_of(*signal)], set_point, moment);
  return {.value = is_new ? set_point.value : image_.values[*signal], .is_new = is_new};
}

/// Returns true if a controller in the bus thread has commanded this controlword and it is not sent
/// yet.
bool PdoOutputs::awaits_sending(SignalIndex signal) const noexcept {
  const Output& output = outputs_[output_of(signal)];
  return output.known && output.commanded && !output.fallen && !refuses(output);
}

/// Checks a new command. A new mode of operation is checked as well, because it may make a
/// set-point effective that is far away. The same is true of a controlword that enables the axis.
void PdoOutputs::judge_commands(std::size_t place, std::span<const SetPoint> set_points,
                                OutputMoment moment) noexcept {
  const OutputLimit& limit = limits_.limit(place);
  const Newest target = newest(limit.signal, set_points, moment);
  const Newest offset = newest(limit.offset, set_points, moment);
  const Newest mode = newest(limit.mode, set_points, moment);
  const Newest order = newest(limit.controlword, set_points, moment);
  const bool begins = limits_.begins(place, order.value) &&
                      (order.is_new || (!limits_.begins(place, limits_.order(place)) &&
                                        awaits_sending(*limit.controlword)));
  if (!target.is_new && !offset.is_new && !mode.is_new && !begins) return;
  Output& output = outputs_[output_of(limit.signal)];
  if (!target.is_new && !output.known) return;
  if (covered(place, mode.value, newest(limit.target, set_points, moment).is_new)) {
    if (target.is_new) end_refusal(place, moment);
    return;
  }
  if (target.is_new && limits_.lacks_start(place, mode.value)) {
    output.generation = set_points[output_of(limit.signal)].generation;
    return;
  }
  const bool held = !target.is_new && !offset.is_new;
  const AxisCommand command{.value = target.value,
                            .offset = offset.value,
                            .mode = mode.value,
                            .order = order.value,
                            .age = held ? SetPointAge::held : SetPointAge::commanded};
  const Cause cause = offset.is_new && !target.is_new ? Cause{*limit.offset, offset.value}
                                                      : Cause{limit.signal, target.value};
  if (judge(place, command, cause, moment)) {
    if (target.is_new || offset.is_new) end_refusal(place, moment);
  } else if (begins && !order.is_new) {
    take_back(*limit.controlword, limits_.order(place));
  }
}

/// Replaces a controlword that a controller in the bus thread has commanded by the one that was
/// sent last, unless the fallback has replaced it.
void PdoOutputs::take_back(SignalIndex signal, std::int64_t before) noexcept {
  if (plan_.layout.signals[signal].fallback == Fallback::hold) image_.values[signal] = before;
}

void PdoOutputs::admit_commands(std::size_t place, std::span<const SetPoint> set_points,
                                OutputMoment moment) noexcept {
  const SignalIndex signal = limits_.limit(place).signal;
  const Newest target = newest(signal, set_points, moment);
  const Newest offset = newest(limits_.limit(place).offset, set_points, moment);
  if (!target.is_new && !offset.is_new) return;
  if (refusals_.holds(plan_.layout.signals[signal].node_index)) return;
  const Newest mode = newest(limits_.limit(place).mode, set_points, moment);
  limits_.admit(place, {.value = target.value, .offset = offset.value, .mode = mode.value},
                moment.cycle);
}

/// Returns true if an output has a command that the last pack has not seen.
bool PdoOutputs::has_new_commands(std::span<const SetPoint> set_points) const noexcept {
  for (std::size_t i = 0; i < outputs_.size(); ++i) {
    if (set_points[i].generation != outputs_[i].generation) return true;
  }
  return false;
}

void PdoOutputs::check_limits(std::span<const SetPoint> set_points, OutputMoment moment) noexcept {
  if (!limits_.concerns_any()) return;
  refusals_.expire(moment.cycle);
  limits_.remember();
  const bool commanded = has_new_commands(set_points);
  for (std::size_t i = 0; i < limits_.size(); ++i) {
    if (!limits_.bounds(i)) continue;
    const auto order = limits_.limit(i).controlword;
    // Without a new command, only a controlword from within the bus thread can need a check.
    if (!commanded && !(order && limits_.begins(i, image_.values[*order]))) continue;
    if (limited_row_open(i)) judge_commands(i, set_points, moment);
  }
  for (std::size_t i = 0; commanded && i < limits_.size(); ++i)
    admit_commands(i, set_points, moment);
  if (!refusals_.holds_any()) return;
  for (std::size_t i = 0; i < outputs_.size(); ++i) {
    const Signal& signal = plan_.layout.signals[inputs_count_ + i];
    if (refusals_.holds(signal.node_index)) outputs_[i].generation = set_points[i].generation;
  }
}

/// Returns the command that consists of this value of an output and of the values in the image for
/// the other outputs.
AxisCommand PdoOutputs::command_with(std::size_t place, SignalIndex signal,
                                     std::int64_t value) const noexcept {
  const OutputLimit& limit = limits_.limit(place);
  const auto of = [&](std::optional<SignalIndex> other) {
    if (!other) return std::int64_t{0};
    return *other == signal ? value : image_.values[*other];
  };
  return {.value = of(limit.signal),
          .offset = of(limit.offset),
          .mode = of(limit.mode),
          .order = of(limit.controlword),
          .age = limit.mode == signal || limit.controlword == signal ? SetPointAge::held
                                                                     : SetPointAge::commanded};
}

/// Returns true if the output is an offset that the check of its target covers. `target_is_new`
/// states whether the target is commanded in this pack.
bool PdoOutputs::covered(std::size_t place, std::int64_t mode, bool target_is_new) const noexcept {
  if (!limits_.covered_by_target(place, mode)) return false;
  const SignalIndex target = *limits_.limit(place).target;
  return limited_row_open(limits_.place_of(target)) &&
         (target_is_new || outputs_[output_of(target)].known);
}

/// Checks a mode of operation or an offset from within the bus thread. A controlword is normally
/// checked when the outputs are packed, because the target may be commanded after it. A
/// controlword is checked here only if commands to the node are already refused and it would enable
/// the axis. If the check fails, the refusal goes on.
bool PdoOutputs::suits_targets(SignalIndex signal, std::int64_t value,
                               OutputMoment moment) noexcept {
  for (const std::uint16_t place : limits_.dependents(signal)) {
    const SignalIndex target = limits_.limit(place).signal;
    const bool repeats =
        refusals_.holds(plan_.layout.signals[signal].node_index) && limits_.begins(place, value);
    if (limits_.limit(place).controlword == signal && !repeats) continue;
    if (!limited_row_open(place) || !outputs_[output_of(target)].known) continue;
    const AxisCommand command = command_with(place, signal, value);
    if (covered(place, command.mode, false)) continue;
    const bool held = command.age == SetPointAge::held;
    const Cause cause = held ? Cause{target, command.value} : Cause{signal, value};
    if (!judge(place, command, cause, moment)) return false;
    if (!held) end_refusal(place, moment);
  }
  return true;
}

bool PdoOutputs::within_limits(SignalIndex signal, std::int64_t value,
                               OutputMoment moment) noexcept {
  if (!limits_.concerns(signal) && !refusals_.holds_any()) return true;
  refusals_.expire(moment.cycle);
  if (!limits_.judges(signal) && !refusals_.holds_any()) return true;
  const std::size_t node_index = plan_.layout.signals[signal].node_index;
  if (!suits_targets(signal, value, moment)) return false;
  const std::uint16_t place = limits_.place_of(signal);
  const bool limited = place != OutputLimits::no_place;
  const AxisCommand command = limited ? command_with(place, signal, value) : AxisCommand{};
  if (limited && limited_row_open(place)) {
    if (limits_.lacks_start(place, command.mode)) return false;
    const bool covers = covered(place, command.mode, false);
    if (!covers && !judge(place, command, {signal, value}, moment)) return false;
    end_refusal(place, moment);
  }
  if (refusals_.holds(node_index)) return false;
  if (limited) limits_.admit(place, command, moment.cycle);
  for (const std::uint16_t target : limits_.dependents(signal)) {
    if (limits_.limit(target).offset != signal) continue;
    limits_.admit(target, command_with(target, signal, value), moment.cycle);
  }
  return true;
}

bool PdoOutputs::settle(SignalIndex signal, std::int64_t value, OutputMoment moment) noexcept {
  if (!trail(signal, value)) return false;
  const std::uint16_t place = limits_.place_of(signal);
  if (place != OutputLimits::no_place) {
    limits_.admit(place, command_with(place, signal, value), moment.cycle);
  }
  return true;
}

void PdoOutputs::pass_over(SignalIndex signal, std::uint64_t cycles, OutputMoment moment) noexcept {
  const std::uint16_t place = limits_.place_of(signal);
  if (place != OutputLimits::no_place) limits_.pass_over(place, cycles, moment.cycle);
}

void PdoOutputs::hold(SignalIndex signal, OutputMoment moment) noexcept {
  Output& output = outputs_[output_of(signal)];
  if (!output.commanded || output.fallen || stopping_ || output.forced) return;
  const std::int64_t value = image_.values[signal];
  const std::uint16_t place = limits_.place_of(signal);
  if (place != OutputLimits::no_place) {
    limits_.admit(place, command_with(place, signal, value), moment.cycle);
  }
  take(output, signal,
       {.value = value, .generation = output.generation, .time_to_live = 0, .when = moment.now},
       moment);
}

/// Returns 1 plus the index of the input whose first value a set-point of this RPDO waits for, see
/// OutputLimits::lacks_start(). 0 means that no set-point waits.
std::uint32_t PdoOutputs::awaited_start(const PdoRow& pdo) const noexcept {
  for (std::uint16_t i = 0; i < pdo.field_count; ++i) {
    const SignalIndex signal = fields_[pdo.first_field + i].signal;
    const std::uint16_t place = limits_.place_of(signal);
    if (place == OutputLimits::no_place || outputs_[output_of(signal)].known) continue;
    const OutputLimit& limit = limits_.limit(place);
    const std::int64_t mode = limit.mode ? image_.values[*limit.mode] : 0;
    if (limit.signal == signal && limits_.lacks_start(place, mode)) return *limit.feedback + 1U;
  }
  return 0;
}

void PdoOutputs::note_limited(std::size_t position, std::uint64_t cycle) noexcept {
  const PdoRow& pdo = plan_.pdos.rpdos[position];
  for (std::uint16_t i = 0; i < pdo.field_count; ++i) {
    const SignalIndex signal = fields_[pdo.first_field + i].signal;
    if (limits_.concerns(signal)) limits_.sent(signal, cycle);
  }
}

}  // namespace takt
