#include "eds_parser/plan/limits/axis_limits.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <string>

#include "eds_parser/plan/device/node_objects.hpp"
#include "eds_parser/plan/limits/limit_proposals.hpp"
#include "eds_parser/table/limit_names.hpp"
#include "eds_parser/table/tpdo_of.hpp"

namespace takt {
namespace {

/// Distance between the objects of two axes of a device (CiA 402).
constexpr std::uint16_t axis_objects = 0x800;

/// The values of 6060 whose modes do not follow each position set-point (CiA 402-2). Profile
/// position takes one by the controlword, the others take none.
constexpr std::array<std::int64_t, 7> modes_without_set_points{1, 2, 3, 4, 6, 9, 10};
/// Largest relative error of a `modulo` that a person has rounded, for example to 6.2832.
constexpr double rounded_digits = 1e-4;

}  // namespace

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
      velocities_{outputs({{0x60FF, 0}, {0x60B1, 0}})} {}

ObjectKey AxisLimits::object(std::uint16_t index, std::uint8_t sub) const {
  return {static_cast<std::uint16_t>(index + (axis_ - 1) * axis_objects), sub};
}

std::optional<SignalIndex> AxisLimits::output(std::uint16_t index, std::uint8_t sub) const {
  return table_.find(node_index_, object(index, sub), true);
}

std::optional<SignalIndex> AxisLimits::input(std::uint16_t index) const {
  return table_.find(node_index_, object(index), false);
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
  return axis_ == 1 ? node : "axis " + std::to_string(axis_) + " of " + node;
}

void AxisLimits::compile(const AxisLimitsSpec& limits) {
  position(limits.position);
  velocity(limits.velocity);
  acceleration(limits.acceleration);
  jerk(limits.jerk);
  step(limits.step);
  torque(limits.torque);
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
  LimitLine& line = plan_.limits.lines.emplace_back();
  line.node_index = static_cast<std::uint8_t>(node_index_);
  line.axis = axis_;
  line.kind = kind;
  line.source = source;
  line.unit = unit_of(kind);
  return line;
}

/// Returns the unit of `units:`, else the one that follows from the unit of positions.
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

bool AxisLimits::has_unit(SignalIndex index, std::string_view kind, SourcePos pos) {
  const Signal& signal = table_.signal(index);
  if (!signal.unit.empty() || signal.scale != 1.0 || signal.offset != 0.0) return true;
  if (node_.spec->units.has_errors) return false;
  report_.error(
      pos, "limits",
      "`" + std::string{kind} + "` in `limits` of " + owner() + ": " + signal.name + " (" +
          to_string(signal.object) +
          ") has no unit, so the limit would apply to raw counts: write a unit under `units:` "
          "(`{scale: 1, unit: counts}` if counts are meant)");
  return false;
}

bool AxisLimits::follows_position(LimitKind kind) const {
  if (positions_.empty()) return true;
  const std::string unit = unit_of(kind);
  return is_limit_rate(unit, table_.signal(positions_[0]).unit, kind);
}

void AxisLimits::tell_other_unit(LimitKind kind, SourcePos pos) {
  if (node_.spec->units.has_errors) return;
  report_.warning(
      pos, "limits",
      "`" + std::string{name(kind)} + "` of " + owner() + " is in " + unit_of(kind) +
          ", but positions are in " + table_.signal(positions_[0]).unit +
          ": takt can't compare this limit with position set-points; use `step` to limit them");
}

void AxisLimits::position(const Sourced<RangeSpec>& range) {
  if (!range.given) {
    if (positions_.empty() || device_position()) return;
    line(LimitKind::position, LimitSource::none);
    return;
  }
  LimitLine& entry = line(LimitKind::position, LimitSource::file);
  entry.low = range->low;
  entry.high = range->high;
  for (const SignalIndex signal : positions_) {
    if (!has_unit(signal, "position", range.pos)) return;
    table_.narrow(signal, table_.raw_bounds(signal, range->low, range->high), LimitKind::position,
                  range.pos);
    entry.signals.push_back(signal);
  }
  add_offset(entry);
}

/// The master checks the sum of the target and of the position offset, so that the limit also holds
/// for the position offset.
void AxisLimits::add_offset(LimitLine& entry) const {
  const auto offset = output(0x60B0);
  if (offset && !entry.signals.empty()) entry.signals.push_back(*offset);
}

void AxisLimits::magnitude(SignalIndex signal, double si, LimitKind kind, SourcePos pos) {
  const double size = table_.raw_size(signal, si);
  const double raw = is_real(table_.signal(signal).type) ? size : std::round(size);
  table_.narrow(signal, {-raw, raw}, kind, pos);
}

void AxisLimits::velocity(const Sourced<double>& limit) {
  if (!limit.given) {
    if ((positions_.empty() && velocities_.empty()) || device_velocity()) return;
    line(LimitKind::velocity, LimitSource::none);
    return;
  }
  LimitLine& entry = line(LimitKind::velocity, LimitSource::file);
  entry.high = *limit;
  const double seconds = cycle_seconds();
  const bool comparable = follows_position(LimitKind::velocity);
  if (!comparable && has_unit(positions_[0], "velocity", limit.pos)) {
    tell_other_unit(LimitKind::velocity, limit.pos);
  }
  for (const SignalIndex signal : outputs({{0x607A, 0}, {0x60C1, 1}, {0x60B0, 0}})) {
    if (!comparable || !has_unit(signal, "velocity", limit.pos)) continue;
    OutputLimit& row = table_.row(signal);
    row.rate = table_.raw_size(signal, *limit) * seconds;
    row.rate_of = LimitKind::velocity;
    entry.signals.push_back(signal);
  }
  for (const SignalIndex signal : outputs({{0x60FF, 0}, {0x60B1, 0}, {0x6081, 0}})) {
    if (!has_unit(signal, "velocity", limit.pos)) continue;
    magnitude(signal, *limit, LimitKind::velocity, limit.pos);
    entry.signals.push_back(signal);
  }
}

void AxisLimits::acceleration(const Sourced<double>& limit) {
  if (!limit.given) {
    const bool shown = !positions_.empty() || !velocities_.empty();
    if (shown && !device_acceleration()) line(LimitKind::acceleration, LimitSource::none);
    return;
  }
  LimitLine& entry = line(LimitKind::acceleration, LimitSource::file);
  entry.high = *limit;
  const double seconds = cycle_seconds();
  const bool comparable = follows_position(LimitKind::acceleration);
  if (!comparable && has_unit(positions_[0], "acceleration", limit.pos)) {
    tell_other_unit(LimitKind::acceleration, limit.pos);
  }
  for (const SignalIndex signal : positions_) {
    if (!comparable || !has_unit(signal, "acceleration", limit.pos)) continue;
    table_.row(signal).bend = table_.raw_size(signal, *limit) * seconds * seconds;
    entry.signals.push_back(signal);
  }
  add_offset(entry);
  for (const SignalIndex signal : velocities_) {
    if (!has_unit(signal, "acceleration", limit.pos)) continue;
    OutputLimit& row = table_.row(signal);
    row.rate = table_.raw_size(signal, *limit) * seconds;
    row.rate_of = LimitKind::acceleration;
    entry.signals.push_back(signal);
  }
  for (const SignalIndex signal : outputs({{0x6083, 0}, {0x6084, 0}})) {
    if (!has_unit(signal, "acceleration", limit.pos)) continue;
    magnitude(signal, *limit, LimitKind::acceleration, limit.pos);
    entry.signals.push_back(signal);
  }
}

void AxisLimits::step(const Sourced<double>& limit) {
  if (!limit.given) {
    if (!positions_.empty()) line(LimitKind::step, LimitSource::none);
    return;
  }
  LimitLine& entry = line(LimitKind::step, LimitSource::file);
  entry.high = *limit;
  for (const SignalIndex signal : outputs({{0x607A, 0}, {0x60C1, 1}, {0x60B0, 0}})) {
    if (!has_unit(signal, "step", limit.pos)) return;
    table_.row(signal).step = table_.raw_size(signal, *limit);
    entry.signals.push_back(signal);
  }
}

void AxisLimits::torque(const Sourced<double>& limit) {
  const std::vector<SignalIndex> signals = outputs({{0x6071, 0}, {0x60B2, 0}});
  if (!limit.given) {
    if (!signals.empty()) line(LimitKind::torque, LimitSource::none);
    return;
  }
  LimitLine& entry = line(LimitKind::torque, LimitSource::file);
  entry.high = *limit;
  for (const SignalIndex signal : signals) {
    if (!has_unit(signal, "torque", limit.pos)) return;
    magnitude(signal, *limit, LimitKind::torque, limit.pos);
    entry.signals.push_back(signal);
  }
}

void AxisLimits::jerk(const Sourced<double>& limit) {
  if (!limit.given) return;
  line(LimitKind::jerk, LimitSource::file).high = *limit;
}

/// Returns the length of the position range limit (CiA 402-2), or 0 if there is none.
double AxisLimits::turn(ObjectReader read) const {
  const auto low = read(node_, object(0x607B, 1));
  const auto high = read(node_, object(0x607B, 2));
  if (!low || !high || *low >= *high) return 0.0;
  return static_cast<double>(*high) - static_cast<double>(*low) + 1.0;
}

/// Returns the length of the range after which a position starts again: `modulo` of the network
/// file, else 607B as `sdo:` writes it. If `modulo` is a rounded form of the drive's own length,
/// the exact length is used. With a length that is too short, each turn-over would look like a
/// movement over the whole range.
double AxisLimits::modulus(const Sourced<double>& modulo, SignalIndex signal) const {
  if (!modulo.given) return turn(written_object);
  const double length = table_.raw_size(signal, *modulo);
  const double of_drive = turn(configured_object);
  return std::abs(of_drive - length) <= 1.0 + length * rounded_digits ? of_drive : length;
}

/// Warns if the drive turns over at another position than its limits assume. Its position would
/// then jump back by a whole turn in one cycle.
void AxisLimits::ask_for_turn(const Sourced<double>& modulo) {
  if (!modulo.given || positions_.empty()) return;
  const double length = modulus(modulo, positions_[0]);
  const double of_drive = turn(configured_object);
  if (of_drive == length) return;
  const ObjectKey key = object(0x607B);
  std::string text = "`modulo` of " + owner() + " is " + std::to_string(std::llround(length)) +
                     " counts of " + table_.signal(positions_[0]).name + ", ";
  text += of_drive > 0 ? "but " + to_string(key) + " (position range limit) wraps after " +
                             std::to_string(std::llround(of_drive))
                       : "but nothing sets " + to_string(key) + " (position range limit)";
  text += ": a drive that doesn't wrap at `modulo` moves back a whole turn at once";
  if (node_.dictionary->find({key.index, 2}) == nullptr) {
    return report_.note(modulo.pos, "limits", text + "; the device file does not have this object");
  }
  report_.warning(modulo.pos, "limits",
                  text + ". Write " + to_string(ObjectKey{key.index, 1}) + " and " +
                      to_string(ObjectKey{key.index, 2}) + " under `sdo:`");
}

/// Sets the data that a position set-point is compared with.
void AxisLimits::describe_position_rows(const AxisLimitsSpec& limits) {
  for (const SignalIndex signal : positions_) {
    const auto& rows = plan_.limits.outputs;
    if (std::ranges::find(rows, signal, &OutputLimit::signal) == rows.end()) continue;
    OutputLimit& row = table_.row(signal);
    row.wraps = !is_real(table_.signal(signal).type);
    row.modulus = modulus(limits.modulo, signal);
    row.feedback = input(0x6064);
    row.statusword = input(0x6041);
    row.mode = output(0x6060);
    row.mode_display = input(0x6061);
    const auto mode = configured_object(node_, object(0x6060));
    const auto& modes = modes_without_set_points;
    row.profile = !row.mode && mode && std::ranges::find(modes, *mode) != modes.end();
  }
}

/// Warns that the first limited set-point waits until the device has sent its actual position.
void AxisLimits::warn_of_late_start(const AxisLimitsSpec& limits) {
  const std::optional<SignalIndex> feedback = input(0x6064);
  if (positions_.empty() || !feedback) return;
  const PdoRow* const tpdo = tpdo_of(plan_.pdos, *feedback);
  if (tpdo == nullptr || !comes_by_event_alone(*tpdo)) return;
  for (const auto* limit : {&limits.step, &limits.velocity, &limits.acceleration}) {
    if (!limit->given) continue;
    const std::string name = "TPDO" + std::to_string(tpdo->number);
    return report_.warning(
        limit->pos, "limits",
        "limits of " + owner() + " hold its set-points back until " + to_string(object(0x6064)) +
            " has arrived once, but " + name + " sends it only by event (transmission " +
            std::to_string(tpdo->transmission) + " without `event_timer`): an axis at standstill " +
            "may never send it. Give " + name +
            " an `event_timer`, or make it synchronous (`transmission: 1`)");
  }
}

}  // namespace takt
