#include "eds_parser/plan/limits/axis_limits.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <string>

#include "eds_parser/plan/limits/limit_proposals.hpp"
#include "eds_parser/table/output_limits.hpp"

namespace takt {

bool is_limit_rate(std::string_view unit, const std::string& base, LimitKind kind) {
  constexpr std::array<std::string_view, 1> per_second{"/s"};
  constexpr std::array<std::string_view, 4> per_second_squared{"/s^2", "/s2", "/s²", "/s/s"};
  const auto is = [&](std::string_view ending) { return unit == base + std::string{ending}; };
  if (kind == LimitKind::velocity) return std::ranges::any_of(per_second, is);
  return std::ranges::any_of(per_second_squared, is);
}

AxisLimits::AxisLimits(const NodeSource& node, std::size_t node_index, std::uint8_t axis,
                       BusPlan& plan, LimitTable& table, NetworkReport& report)
    : node_{node},
      node_index_{node_index},
      axis_{axis},
      plan_{plan},
      table_{table},
      report_{report},
      positions_{outputs({{0x607A, 0}, {0x60C1, 1}})},
      velocities_{outputs({{0x60FF, 0}, {0x60B1, 0}})},
      torques_{outputs({{0x6071, 0}, {0x60B2, 0}})} {}

ObjectKey AxisLimits::object(std::uint16_t index, std::uint8_t sub) const {
  return axis_object(axis_ - 1U, index, sub);
}

std::optional<SignalIndex> AxisLimits::output(std::uint16_t index, std::uint8_t sub) const {
  return plan_.layout.find(node_index_, object(index, sub), true);
}

std::optional<SignalIndex> AxisLimits::input(std::uint16_t index) const {
  return plan_.layout.find(node_index_, object(index), false);
}

std::vector<SignalIndex> AxisLimits::outputs(std::initializer_list<ObjectKey> keys) const {
  std::vector<SignalIndex> found;
  for (const ObjectKey key : keys) {
    if (const auto signal = output(key.index, key.sub)) found.push_back(*signal);
  }
  return found;
}

std::string AxisLimits::owner() const {
  const std::string node = "node `" + node_.spec->name + "`";
  return axis_ == 1 ? node : concat("axis ", axis_, " of ", node);
}

void AxisLimits::compile(const AxisLimitsSpec& limits) {
  position(limits.position);
  velocity(limits.velocity);
  acceleration(limits.acceleration);
  line_of_file(LimitKind::jerk, limits.jerk, false);
  line_of_file(LimitKind::following_error, limits.following_error, false);
  step(limits.step);
  torque(limits.torque);
  // The motions of a rotary axis need a row with its modulo, even if no limit is checked.
  for (const SignalIndex signal : positions_) {
    if (modulus(limits.modulo, signal) > 0.0) table_.row(signal);
  }
  describe_rows();
  describe_position_rows(limits);
  ask_for_turn(limits.modulo);
  warn_of_late_start(limits);
  for (LimitLine& line : plan_.limits.lines) {
    if (line.node_index == node_index_ && line.axis == axis_) {
      propose_limit(line, node_, plan_, table_);
    }
  }
}

double AxisLimits::cycle_seconds() const {
  return std::chrono::duration<double>(plan_.cycle.period).count();
}

LimitLine& AxisLimits::line(LimitKind kind, LimitSource source) {
  return plan_.limits.lines.emplace_back(
      LimitLine{.node_index = static_cast<std::uint8_t>(node_index_),
                .axis = axis_,
                .kind = kind,
                .source = source,
                .unit = unit_of(kind)});
}

LimitLine* AxisLimits::line_of_file(LimitKind kind, const Sourced<double>& limit, bool shown) {
  if (!limit.given && shown) line(kind, LimitSource::none);
  if (!limit.given) return nullptr;
  LimitLine& entry = line(kind, LimitSource::file);
  entry.high = *limit;
  return &entry;
}

/// Returns the unit that `units:` gives to this kind of limit, else the unit that follows from the
/// unit of positions.
std::string AxisLimits::unit_of(LimitKind kind) const {
  const UnitsSpec& units = node_.spec->units;
  const std::string base = positions_.empty() ? "" : table_.signal(positions_[0]).unit;
  const auto rate = [&](const std::optional<UnitSpec>& unit, const char* ending) {
    if (unit && !unit->unit.empty()) return unit->unit;
    return base.empty() ? "" : base + ending;
  };
  switch (kind) {
    case LimitKind::position:
    case LimitKind::step:
    case LimitKind::range:
    case LimitKind::following_error:
      return base;
    case LimitKind::velocity:
      return rate(units.velocity, "/s");
    case LimitKind::acceleration:
      return rate(units.acceleration, "/s^2");
    case LimitKind::jerk:
      return base.empty() ? "" : base + "/s^3";
    case LimitKind::torque:
      return units.torque ? units.torque->unit : "";
  }
  return base;
}

bool AxisLimits::has_unit(SignalIndex index, LimitKind kind, SourcePos pos) {
  const Signal& signal = table_.signal(index);
  if (!signal.unit.empty() || signal.scale != 1.0 || signal.offset != 0.0) return true;
  if (node_.spec->units.has_errors) return false;
  report_.error(pos, "limits", "`", name(kind), "` in `limits` of ", owner(), ": ", signal.name,
                " (", signal.object,
                ") has no unit, so the limit would apply to raw counts: write a unit under "
                "`units:` (`{scale: 1, unit: counts}` if counts are meant)");
  return false;
}

bool AxisLimits::follows_position(LimitKind kind) const {
  if (positions_.empty()) return true;
  const std::string unit = unit_of(kind);
  return is_limit_rate(unit, table_.signal(positions_[0]).unit, kind);
}

bool AxisLimits::is_comparable(LimitKind kind, SourcePos pos) {
  if (follows_position(kind)) return true;
  if (!has_unit(positions_[0], kind, pos) || node_.spec->units.has_errors) return false;
  report_.warning(
      pos, "limits", "`", name(kind), "` of ", owner(), " is in ", unit_of(kind),
      ", but positions are in ", table_.signal(positions_[0]).unit,
      ": takt can't compare this limit with position set-points; use `step` to limit them");
  return false;
}

void AxisLimits::position(const Sourced<RangeSpec>& range) {
  if (!range.given) {
    if (!positions_.empty() && !device_position()) line(LimitKind::position, LimitSource::none);
    return;
  }
  LimitLine& entry = line(LimitKind::position, LimitSource::file);
  entry.low = range->low;
  entry.high = range->high;
  for (const SignalIndex signal : positions_) {
    if (!has_unit(signal, LimitKind::position, range.pos)) return;
    table_.narrow(signal, table_.raw_bounds(signal, range->low, range->high), LimitKind::position,
                  range.pos);
    entry.signals.push_back(signal);
  }
  add_offset(entry);
}

/// Adds the position offset to the signals of a limit. The master checks the sum of target and
/// offset, so the limit also holds for the offset.
void AxisLimits::add_offset(LimitLine& entry) const {
  const auto offset = output(0x60B0);
  if (offset && !entry.signals.empty()) entry.signals.push_back(*offset);
}

void AxisLimits::magnitude(LimitLine& entry, SignalIndex signal, SourcePos pos) {
  const double size = table_.raw_size(signal, *entry.high);
  const double raw = is_real(table_.signal(signal).type) ? size : std::round(size);
  table_.narrow(signal, {-raw, raw}, entry.kind, pos);
  entry.signals.push_back(signal);
}

void AxisLimits::rate(LimitLine& entry, SignalIndex signal) {
  OutputLimit& row = table_.row(signal);
  row.rate = table_.raw_size(signal, *entry.high) * cycle_seconds();
  row.rate_of = entry.kind;
  entry.signals.push_back(signal);
}

void AxisLimits::velocity(const Sourced<double>& limit) {
  constexpr LimitKind kind = LimitKind::velocity;
  const bool moves = !positions_.empty() || !velocities_.empty();
  LimitLine* entry = line_of_file(kind, limit, !limit.given && moves && !device_velocity());
  if (entry == nullptr) return;
  const bool comparable = is_comparable(kind, limit.pos);
  for (const SignalIndex signal : outputs({{0x607A, 0}, {0x60C1, 1}, {0x60B0, 0}})) {
    if (comparable && has_unit(signal, kind, limit.pos)) rate(*entry, signal);
  }
  for (const SignalIndex signal : outputs({{0x60FF, 0}, {0x60B1, 0}, {0x6081, 0}})) {
    if (has_unit(signal, kind, limit.pos)) magnitude(*entry, signal, limit.pos);
  }
}

void AxisLimits::acceleration(const Sourced<double>& limit) {
  constexpr LimitKind kind = LimitKind::acceleration;
  const bool moves = !positions_.empty() || !velocities_.empty();
  LimitLine* entry = line_of_file(kind, limit, !limit.given && moves && !device_acceleration());
  if (entry == nullptr) return;
  const double seconds = cycle_seconds();
  const bool comparable = is_comparable(kind, limit.pos);
  for (const SignalIndex signal : positions_) {
    if (!comparable || !has_unit(signal, kind, limit.pos)) continue;
    table_.row(signal).bend = table_.raw_size(signal, *limit) * seconds * seconds;
    entry->signals.push_back(signal);
  }
  add_offset(*entry);
  for (const SignalIndex signal : velocities_) {
    if (has_unit(signal, kind, limit.pos)) rate(*entry, signal);
  }
  for (const SignalIndex signal : outputs({{0x6083, 0}, {0x6084, 0}})) {
    if (has_unit(signal, kind, limit.pos)) magnitude(*entry, signal, limit.pos);
  }
}

void AxisLimits::step(const Sourced<double>& limit) {
  LimitLine* entry = line_of_file(LimitKind::step, limit, !positions_.empty());
  if (entry == nullptr) return;
  for (const SignalIndex signal : outputs({{0x607A, 0}, {0x60C1, 1}, {0x60B0, 0}})) {
    if (!has_unit(signal, LimitKind::step, limit.pos)) return;
    table_.row(signal).step = table_.raw_size(signal, *limit);
    entry->signals.push_back(signal);
  }
}

void AxisLimits::torque(const Sourced<double>& limit) {
  LimitLine* entry = line_of_file(LimitKind::torque, limit, !torques_.empty());
  if (entry == nullptr) return;
  for (const SignalIndex signal : torques_) {
    if (!has_unit(signal, LimitKind::torque, limit.pos)) return;
    magnitude(*entry, signal, limit.pos);
  }
}

}  // namespace takt
