#include <cmath>

#include "eds_parser/plan/limits/axis_limits.hpp"

// Limits that are read from a drive in each boot, for kinds that the network file does not limit.

namespace takt {

bool AxisLimits::reports(ObjectKey object) const {
  const SubObject* sub = node_.dictionary->find(object);
  if (sub == nullptr || sub->access == Access::wo) return false;
  return bit_width(sub->type) == 32 && !is_real(sub->type);
}

LimitLine& AxisLimits::device_line(LimitKind kind, ObjectKey object, double scale) {
  LimitLine& entry = line(kind, LimitSource::device);
  entry.object = object;
  entry.scale = std::abs(scale);
  return entry;
}

void AxisLimits::read_at_boot(LimitLine& entry, SignalIndex signal, DeviceBound bound,
                              double factor) {
  OutputLimit& row = table_.row(signal);
  if (bound == DeviceBound::range || bound == DeviceBound::size) row.range = entry.kind;
  if (bound == DeviceBound::rate) row.rate_of = entry.kind;
  entry.signals.push_back(signal);
  const auto place = static_cast<std::uint16_t>(plan_.limits.lines.size() - 1);
  plan_.limits.device.push_back({.node_index = static_cast<std::uint8_t>(node_index_),
                                 .object = entry.object,
                                 .signal = signal,
                                 .bound = bound,
                                 .factor = factor,
                                 .line = place});
}

/// Limits positions by 607D, which has the unit of 607A.
bool AxisLimits::device_position() {
  const ObjectKey low = object(0x607D, 1);
  if (!reports(low) || !reports(object(0x607D, 2))) return false;
  const Signal& first = table_.signal(positions_[0]);
  LimitLine& entry = device_line(LimitKind::position, low, 1.0);
  entry.scale = first.scale;
  entry.offset = first.offset;
  for (const SignalIndex signal : positions_) {
    read_at_boot(entry, signal, DeviceBound::range, 1.0);
  }
  add_offset(entry);
  return true;
}

/// Limits velocities by 607F, which has the unit of 60FF and 6081. The limit also applies to the
/// steps of positions if `units:` defines how velocities and positions relate.
bool AxisLimits::device_velocity() {
  const ObjectKey most = object(0x607F);
  const auto& unit = node_.spec->units.velocity;
  const bool comparable =
      unit && !unit->unit.empty() && !positions_.empty() && follows_position(LimitKind::velocity);
  const std::vector<SignalIndex> magnitudes = outputs({{0x60FF, 0}, {0x60B1, 0}, {0x6081, 0}});
  if (!reports(most) || (magnitudes.empty() && !comparable)) return false;
  LimitLine& entry = device_line(LimitKind::velocity, most, unit ? *unit->scale : 1.0);
  for (const SignalIndex signal : positions_) {
    if (!comparable) break;
    const double counts = std::abs(*unit->scale / table_.signal(signal).scale);
    read_at_boot(entry, signal, DeviceBound::rate, counts * cycle_seconds());
  }
  add_offset(entry);
  for (const SignalIndex signal : magnitudes) {
    read_at_boot(entry, signal, DeviceBound::size, 1.0);
  }
  return true;
}

/// Limits accelerations by 60C5. It has the unit of 6083, so `units:` must define how this unit
/// relates to the commanded values.
bool AxisLimits::device_acceleration() {
  const ObjectKey most = object(0x60C5);
  const auto& unit = node_.spec->units.acceleration;
  const auto& speed = node_.spec->units.velocity;
  if (!unit || unit->unit.empty() || !reports(most)) return false;
  const bool of_positions = !positions_.empty() && follows_position(LimitKind::acceleration);
  const bool of_velocities = speed && !velocities_.empty() &&
                             (is_limit_rate(unit->unit, speed->unit, LimitKind::velocity) ||
                              (of_positions && follows_position(LimitKind::velocity)));
  const auto profile = output(0x6083);
  if (!of_positions && !of_velocities && !profile) return false;
  LimitLine& entry = device_line(LimitKind::acceleration, most, *unit->scale);
  const auto counts = [&](SignalIndex signal) {
    return std::abs(*unit->scale / table_.signal(signal).scale) * cycle_seconds();
  };
  for (const SignalIndex signal : positions_) {
    if (!of_positions) break;
    read_at_boot(entry, signal, DeviceBound::bend, counts(signal) * cycle_seconds());
  }
  add_offset(entry);
  for (const SignalIndex signal : velocities_) {
    if (!of_velocities) break;
    read_at_boot(entry, signal, DeviceBound::rate, counts(signal));
  }
  if (profile) read_at_boot(entry, *profile, DeviceBound::size, 1.0);
  return true;
}

}  // namespace takt
