#include <algorithm>
#include <bit>
#include <cstring>
#include <optional>

#include "master/core/pdo_outputs.hpp"

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
  std::optional<std::uint16_t> told;
  for (const DeviceLimit& limit : plan_.limits.device) {
    if (limit.node_index != node_index) continue;
    const bool is_range = limit.bound == DeviceBound::range;
    const auto first = value_of(readings, limit.object);
    const auto last = is_range ? value_of(readings, upper_object(limit)) : first;
    if (!first || !last) continue;
    const auto verdict =
        limits_.narrow(limit, *first, *last) ? LimitVerdict::good : LimitVerdict::implausible;
    if (told == limit.line) continue;
    told = limit.line;
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

bool PdoOutputs::judge(std::size_t place, std::int64_t value, std::int64_t mode,
                       OutputMoment moment) noexcept {
  const SignalIndex signal = limits_.limit(place).signal;
  const auto found = limits_.judge(place, value, mode, obeying(signal), moment.cycle);
  if (!found) return true;
  const Signal& what = plan_.layout.signals[signal];
  if (limits_.refuse(place, moment.cycle)) {
    Event event{.when = moment.now,
                .cycle = moment.cycle,
                .kind = EventKind::limit_exceeded,
                .node = what.node.value(),
                .detail = std::uint32_t{signal} << 8U | static_cast<std::uint32_t>(found->kind),
                .value = value};
    std::memcpy(event.bytes.data(), &found->measured, 4);
    std::memcpy(event.bytes.data() + 4, &found->limit, 4);
    events_.push(event);
  }
  drop_node(what.node_index);
  return false;
}

/// A cycle without outputs, or an inhibit time, may delay the fallback. Until the fallback is sent,
/// the axis follows its set-points, but commands would be judged as those of an axis that does not
/// follow. So the refusal lasts until then.
void PdoOutputs::forgive(std::size_t place, OutputMoment moment) noexcept {
  const std::size_t node_index = plan_.layout.signals[limits_.limit(place).signal].node_index;
  if (!limits_.holds(node_index)) return;
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const Row& row = rows_[i];
    const bool waits = row.open && row.ready && row.pending;
    if (waits && plan_.pdos.rpdos[i].node_index == node_index) return;
  }
  limits_.forgive(place, moment.cycle);
}

/// Judges a new command. A new mode of operation is judged as well, because the position that it
/// makes valid may be far away.
void PdoOutputs::judge_news(std::size_t place, std::span<const SetPoint> set_points,
                            OutputMoment moment) noexcept {
  const OutputLimit& limit = limits_.limit(place);
  const auto news = [&](SignalIndex signal) {
    return is_news(outputs_[output_of(signal)], set_points[output_of(signal)], moment);
  };
  const bool new_value = news(limit.signal);
  const bool new_mode = limit.mode && news(*limit.mode);
  if (!new_value && !new_mode) return;
  const std::int64_t value =
      new_value ? set_points[output_of(limit.signal)].value : image_.values[limit.signal];
  std::int64_t mode = 0;
  if (limit.mode) {
    mode = new_mode ? set_points[output_of(*limit.mode)].value : image_.values[*limit.mode];
  }
  Output& output = outputs_[output_of(limit.signal)];
  if (!new_value && !output.known) return;
  if (new_value && limits_.lacks_start(place, mode)) {
    output.generation = set_points[output_of(limit.signal)].generation;
    return;
  }
  if (judge(place, value, mode, moment) && new_value) forgive(place, moment);
}

void PdoOutputs::check_limits(std::span<const SetPoint> set_points, OutputMoment moment) noexcept {
  limits_.expire(moment.cycle);
  for (std::size_t i = 0; i < limits_.size(); ++i) {
    if (limits_.bounds(i) && limited_row_open(i)) judge_news(i, set_points, moment);
  }
  for (std::size_t i = 0; i < limits_.size(); ++i) {
    const SignalIndex signal = limits_.limit(i).signal;
    const SetPoint& set_point = set_points[output_of(signal)];
    const Output& output = outputs_[output_of(signal)];
    const bool taken = is_news(output, set_point, moment) &&
                       !limits_.holds(plan_.layout.signals[signal].node_index);
    if (taken) limits_.admit(i, set_point.value, moment.cycle);
  }
  if (!limits_.holds_any()) return;
  for (std::size_t i = 0; i < outputs_.size(); ++i) {
    const Signal& signal = plan_.layout.signals[inputs_count_ + i];
    if (limits_.holds(signal.node_index)) outputs_[i].generation = set_points[i].generation;
  }
}

bool PdoOutputs::within_limits(SignalIndex signal, std::int64_t value,
                               OutputMoment moment) noexcept {
  limits_.expire(moment.cycle);
  const std::size_t node_index = plan_.layout.signals[signal].node_index;
  const std::uint16_t place = limits_.place_of(signal);
  if (place == OutputLimits::no_place) return !limits_.holds(node_index);
  if (!limited_row_open(place)) return true;
  const OutputLimit& limit = limits_.limit(place);
  if (limit.signal != signal) {  // `signal` is the mode of operation of an axis
    if (!outputs_[output_of(limit.signal)].known) return !limits_.holds(node_index);
    return judge(place, image_.values[limit.signal], value, moment) && !limits_.holds(node_index);
  }
  const std::int64_t mode = limit.mode ? image_.values[*limit.mode] : 0;
  if (limits_.lacks_start(place, mode) || !judge(place, value, mode, moment)) return false;
  forgive(place, moment);
  if (limits_.holds(node_index)) return false;
  limits_.admit(place, value, moment.cycle);
  return true;
}

/// Index of the input for whose first value a set-point of this RPDO waits, plus 1; 0 means none.
/// See OutputLimits::lacks_start().
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
    limits_.sent(fields_[pdo.first_field + i].signal, cycle);
  }
}

}  // namespace takt
