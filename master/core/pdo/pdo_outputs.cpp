#include "master/core/pdo/pdo_outputs.hpp"

namespace takt {

PdoOutputs::PdoOutputs(const BusPlan& plan, WorkingImage& image, const PdoInputs& inputs,
                       EventQueue& events)
    : plan_{plan},
      image_{image},
      inputs_{inputs},
      events_{events},
      inputs_count_{plan.layout.inputs},
      limits_{plan, image, inputs},
      refusals_{plan},
      outputs_(plan.layout.outputs()),
      rows_(plan.pdos.rpdos.size()),
      begun_(plan.nodes.size(), 0),
      led_(plan.nodes.size()),
      frames_(plan.pdos.rpdos.size()),
      packed_(plan.pdos.rpdos.size()) {
  fields_.reserve(plan.pdos.fields.size());
  for (const PdoField& field : plan.pdos.fields) fields_.push_back(compile(field));
  for (std::size_t i = 0; i < outputs_.size(); ++i) {
    const Signal& signal = plan.layout.signals[inputs_count_ + i];
    if (signal.safe_value) image_.values[inputs_count_ + i] = *signal.safe_value;
  }
}

void PdoOutputs::open(std::size_t node_index, std::span<const SetPoint> set_points) noexcept {
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const PdoRow& pdo = plan_.pdos.rpdos[i];
    if (pdo.node_index != node_index || pdo.on_request) continue;
    rows_[i] = Row{.sent = rows_[i].sent, .open = true};
  }
  begun_[node_index] = 0;
  led_[node_index] = {};
  limits_.open(node_index);
  refusals_.open(node_index);
  for (std::size_t i = 0; i < outputs_.size(); ++i) {
    const Signal& signal = plan_.layout.signals[inputs_count_ + i];
    if (signal.node_index != node_index) continue;
    outputs_[i] = Output{.generation = set_points[i].generation, .limit = signal.fallback_cycles};
  }
}

void PdoOutputs::shut(std::size_t node_index) noexcept {
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    if (plan_.pdos.rpdos[i].node_index == node_index) rows_[i] = Row{.sent = rows_[i].sent};
  }
}

void PdoOutputs::announce(EventKind kind, std::size_t row, std::int64_t value, OutputMoment moment,
                          std::uint32_t detail) noexcept {
  events_.push({.when = moment.now,
                .cycle = moment.cycle,
                .kind = kind,
                .node = plan_.pdos.rpdos[row].node.value(),
                .detail = detail,
                .value = value});
}

void PdoOutputs::fall(Output& output, SignalIndex signal) noexcept {
  const Signal& what = plan_.layout.signals[signal];
  output.fallen = true;
  if (what.fallback == Fallback::value) image_.values[signal] = what.fallback_value;
}

/// Lets the output take its fallback because its sender has released it. An output without a time
/// to live keeps its value, as it does when no more commands come.
void PdoOutputs::release_output(Output& output, SignalIndex signal) noexcept {
  if (!output.commanded || output.fallen || output.limit == 0) return;
  fall(output, signal);
  output.released = true;
}

void PdoOutputs::seed(Output& output, SignalIndex signal) noexcept {
  const Signal& what = plan_.layout.signals[signal];
  if (what.safe_value) {
    image_.values[signal] = *what.safe_value;
    output.known = true;
  } else if (what.seeded_from && inputs_.fresh(*what.seeded_from)) {
    image_.values[signal] = image_.values[*what.seeded_from];
    output.known = true;
  }
}

/// Handles a new command of the front thread that has waited, that ends a fallback, or that is
/// refused. Returns true if the command was taken. A release that has to wait remains a new
/// command.
bool PdoOutputs::hear(Row& row, Output& output, SignalIndex signal, const SetPoint& set_point,
                      OutputMoment moment) noexcept {
  const bool released = set_point.time_to_live == output_released;
  if (released && release_waits(output, signal)) return false;
  if (released || refuses(output) || is_late(output, set_point, moment)) {
    output.generation = set_point.generation;
    if (released && !refuses(output)) release_output(output, signal);
    return false;
  }
  if (output.fallen && !output.released && row.risen++ == 0) row.first_risen = signal;
  take(output, signal, set_point, moment);
  return true;
}

/// build_all() calls this function for each row, so the function is compiled into build_all().
[[gnu::always_inline]] inline PdoOutputs::Built PdoOutputs::build(
    std::size_t position, std::span<const SetPoint> set_points, OutputMoment moment,
    Time prompt) noexcept {
  const PdoRow& pdo = plan_.pdos.rpdos[position];
  Row& row = rows_[position];
  // The loop stores values, so the compiler would load the members again for each field.
  const std::size_t inputs = inputs_count_;
  const FieldProgram* const fields = fields_.data() + pdo.first_field;
  std::int64_t* const values = image_.values.data();
  Output* const outputs = outputs_.data();
  const bool stopping = stopping_;
  bool begun = begun_[pdo.node_index] != 0;
  std::uint32_t fresh = 0;
  Built built{.word = pdo.header};
  row.fallen = 0;
  row.risen = 0;
  for (std::size_t i = 0; i < pdo.field_count; ++i) {
    const FieldProgram& field = fields[i];
    Output& output = outputs[field.signal - inputs];
    const SetPoint& set_point = set_points[field.signal - inputs];
    if (set_point.generation != output.generation) {
      // Nearly every command comes in time, and its output follows commands. Such a command ends no
      // fallback and does not expire in this cycle, so nothing else is left to be done.
      const bool follows = !output.fallen && !stopping && !output.forced && !output.led;
      if (follows && set_point.when > prompt && set_point.time_to_live != output_released)
          [[likely]] {
        output.generation = set_point.generation;
        const std::uint32_t limit = limit_of(output, set_point.time_to_live);
        output.expires = limit == 0 ? no_end : moment.cycle + limit;
        output.known = output.commanded = begun = true;
        values[field.signal] = set_point.value;
        built.word |= put_field(set_point.value, field);
        ++fresh;
        continue;
      }
      fresh += hear(row, output, field.signal, set_point, moment);
    }
    if (moment.cycle >= output.expires && !output.fallen && !output.forced) [[unlikely]] {
      fall(output, field.signal);
      if (row.fallen++ == 0) row.first_fallen = field.signal;
    }
    if (!output.commanded && !(begun && output.known)) [[unlikely]] {
      seed(output, field.signal);
    }
    begun |= output.commanded;
    built.lacking |= !output.known;
    built.word |= put_field(values[field.signal], field);
  }
  begun_[pdo.node_index] = begun;
  fresh_commands_ += fresh;
  built.commanded = fresh != 0;
  return built;
}

void PdoOutputs::report_changes(std::size_t position, bool lacking, OutputMoment moment) noexcept {
  Row& row = rows_[position];
  const PdoRow& pdo = plan_.pdos.rpdos[position];
  if (row.fallen != 0) {
    announce(EventKind::fallback_begun, position, row.first_fallen, moment, row.fallen);
  }
  if (row.risen != 0) {
    announce(EventKind::fallback_ended, position, row.first_risen, moment, row.risen);
  }
  if (!lacking || begun_[pdo.node_index] == 0 || row.held_reported) return;
  if (++row.partial < partial_limit) return;
  announce(EventKind::outputs_held, position, pdo.number, moment, awaited_start(pdo));
  row.held_reported = true;
}

/// Returns true if the RPDO is due. Times are counted in cycles, so a late wake-up of the thread
/// does not make them longer. A frame that was sent late may shorten the inhibit time before the
/// next one, but by no more than a quarter of a period.
bool PdoOutputs::due(std::size_t position, OutputMoment moment) const noexcept {
  const PdoRow& pdo = plan_.pdos.rpdos[position];
  const Row& row = rows_[position];
  if (!row.ever_sent || row.due) return true;
  if (pdo.cyclic()) {
    return stopping_ || pdo.transmission == 1 || turn_ % pdo.transmission == 0;
  }
  if (pdo.synchronous()) return row.pending;
  const Time period = plan_.cycle.period;
  const Time since = static_cast<std::int64_t>(moment.cycle - row.last_cycle) * period;
  const bool near = moment.now - row.last_sent < pdo.inhibit - period / 4;
  if (since < pdo.inhibit || near) return false;
  return row.pending || (pdo.event_timer > Time{0} && since >= pdo.event_timer);
}

bool PdoOutputs::build_all(std::span<const SetPoint> set_points, OutputMoment moment) noexcept {
  unsigned together = 0;
  const Time prompt = prompt_after(moment);
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    Row& row = rows_[i];
    if (!row.open) continue;
    const Built built = build(i, set_points, moment, prompt);
    row.ready = !built.lacking;
    if (built.lacking || row.fallen != 0 || row.risen != 0) [[unlikely]] {
      report_changes(i, built.lacking, moment);
    }
    row.pending |= built.word != row.word;
    row.word = built.word;
    together += row.pending && built.commanded && row.ready && plan_.pdos.rpdos[i].synchronous();
  }
  return together > 1;
}

std::span<const Frame> PdoOutputs::pack(std::span<const SetPoint> set_points,
                                        OutputMoment moment) noexcept {
  packed_count_ = 0;
  fresh_commands_ = 0;
  if (!limits_.empty()) [[unlikely]] {
    check_limits(set_points, moment);
  }
  const bool together = build_all(set_points, moment);
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    Row& row = rows_[i];
    if (!row.ready || !row.open) continue;
    const PdoRow& pdo = plan_.pdos.rpdos[i];
    row.due = due(i, moment) || (together && row.pending && pdo.synchronous());
    if (row.due) add_frame(i);
  }
  ++turn_;
  return {frames_.data(), packed_count_};
}

const Frame& PdoOutputs::add_frame(std::size_t position) noexcept {
  const PdoRow& pdo = plan_.pdos.rpdos[position];
  Frame& frame = frames_[packed_count_];
  frame.id = pdo.cob_id;
  frame.length = pdo.length;
  frame.rtr = false;
  store(rows_[position].word, frame);
  packed_[packed_count_++] = static_cast<std::uint16_t>(position);
  return frame;
}

std::span<const Frame> PdoOutputs::pack_less(
    std::int64_t bits, std::int64_t (*bits_of)(const Frame&) noexcept) noexcept {
  const auto wanted = [this](std::size_t position, bool synchronous) {
    const Row& row = rows_[position];
    return row.open && row.ready && row.due &&
           plan_.pdos.rpdos[position].synchronous() == synchronous;
  };
  packed_count_ = 0;
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    if (wanted(i, true)) bits -= bits_of(add_frame(i));
  }
  if (bits < 0) packed_count_ = 0;
  const std::size_t first = next_event_;
  for (std::size_t k = 0; k < rows_.size() && bits >= 0; ++k) {
    const std::size_t i = (first + k) % rows_.size();
    if (!wanted(i, false)) continue;
    bits -= bits_of(add_frame(i));
    if (bits >= 0) continue;
    --packed_count_;
    next_event_ = i;
  }
  return {frames_.data(), packed_count_};
}

void PdoOutputs::sent(std::size_t count, OutputMoment moment) noexcept {
  for (std::size_t i = 0; i < std::min(count, packed_count_); ++i) {
    Row& row = rows_[packed_[i]];
    row.last_sent = moment.now;
    row.last_cycle = moment.cycle;
    row.ever_sent = true;
    row.pending = row.due = false;
    ++row.sent;
    if (limits_.concerns_any()) [[unlikely]] {
      note_limited(packed_[i], moment.cycle);
    }
  }
  packed_count_ = 0;
}

void PdoOutputs::command(SignalIndex signal, std::int64_t value, std::uint32_t time_to_live,
                         OutputMoment moment) noexcept {
  if (signal < inputs_count_ || signal >= image_.values.size()) return;
  Output& output = outputs_[output_of(signal)];
  if (refuses(output)) return;
  if (limits_.concerns(signal) || refusals_.holds_any()) {
    return command_limited(signal, value, time_to_live, moment);
  }
  accept(output, limit_of(output, time_to_live), 0, moment);
  image_.values[signal] = value;
}

/// Does the work of command() for an output that has a limit. This is a separate function, so that
/// command() need not save the registers of the check for the other outputs.
void PdoOutputs::command_limited(SignalIndex signal, std::int64_t value, std::uint32_t time_to_live,
                                 OutputMoment moment) noexcept {
  if (!within_limits(signal, value, moment)) return;
  Output& output = outputs_[output_of(signal)];
  accept(output, limit_of(output, time_to_live), 0, moment);
  image_.values[signal] = value;
}

bool PdoOutputs::lead(SignalIndex signal, std::int64_t value, OutputMoment moment) noexcept {
  Output& output = outputs_[output_of(signal)];
  if (is_overruled(signal)) return false;
  set_led(signal, true);
  if (!limits_.empty() && !within_limits(signal, value, moment)) return false;
  take(output, signal,
       {.value = value, .generation = output.generation, .time_to_live = 0, .when = moment.now},
       moment);
  return true;
}

/// Returns true if a release of this output waits until the motions of its axis have ended. If the
/// output belongs to no axis, the release waits for the motions of all axes of its node.
bool PdoOutputs::release_waits(const Output& output, SignalIndex signal) const noexcept {
  if (stopping_ || output.forced) return false;
  const Signal& what = plan_.layout.signals[signal];
  const auto& led = led_[what.node_index];
  const auto axis = axis_of(what.object);
  return axis ? led[*axis] != 0 : std::ranges::any_of(led, [](unsigned count) { return count; });
}

bool PdoOutputs::trail(SignalIndex signal, std::int64_t value) noexcept {
  const Output& output = outputs_[output_of(signal)];
  const bool fallen = output.fallen && plan_.layout.signals[signal].fallback == Fallback::value;
  if (!output.known || stopping_ || output.forced || fallen) return false;
  image_.values[signal] = value;
  return true;
}

void PdoOutputs::fall_back() noexcept {
  stopping_ = true;
  for (std::size_t i = 0; i < outputs_.size(); ++i) {
    Output& output = outputs_[i];
    if (output.commanded && !output.fallen) {
      fall(output, static_cast<SignalIndex>(inputs_count_ + i));
    }
  }
}

void PdoOutputs::force(SignalIndex signal, std::int64_t value) noexcept {
  Output& output = outputs_[output_of(signal)];
  output.forced = true;
  output.expires = no_end;
  output.known = true;
  output.commanded = true;
  image_.values[signal] = value;
}

void PdoOutputs::release(SignalIndex signal) noexcept {
  outputs_[output_of(signal)].forced = false;
}

}  // namespace takt
