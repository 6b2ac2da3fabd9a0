#include <algorithm>
#include <cmath>
#include <string>

#include "eds_parser/plan/device/node_objects.hpp"
#include "eds_parser/plan/limits/axis_limits.hpp"
#include "eds_parser/table/pdo_table.hpp"

// These functions enter the data that the bus thread needs, besides the limits, to check the
// set-points of an axis.

namespace takt {
namespace {

/// Largest relative error of a `modulo` that was rounded by hand, for example to 6.2832.
constexpr double rounded_digits = 1e-4;

}  // namespace

/// Returns the length of the position range limit (CiA 402-2), or 0 if there is none.
double AxisLimits::turn(ObjectReader read) const {
  const auto low = read(node_, object(0x607B, 1));
  const auto high = read(node_, object(0x607B, 2));
  if (!low || !high || *low >= *high) return 0.0;
  return static_cast<double>(*high) - static_cast<double>(*low) + 1.0;
}

/// Returns the length of the range after which a position starts again: `modulo` of the network
/// file, else 607B as `sdo:` writes it. If `modulo` is a rounded form of the drive's own length,
/// the exact length is used. With a length that is too short, each wrap would look like a movement
/// over the whole range.
double AxisLimits::modulus(const Sourced<double>& modulo, SignalIndex signal) const {
  if (!modulo.given) return turn(written_object);
  const double length = table_.raw_size(signal, *modulo);
  const double of_drive = turn(configured_object);
  return std::abs(of_drive - length) <= 1.0 + length * rounded_digits ? of_drive : length;
}

/// Returns the position at which a turn begins: the lower limit of the drive's position range
/// (607B:01), else the lower limit of commands, else 0. The result is chosen so that the whole turn
/// fits into an INTEGER32.
double AxisLimits::lowest(const OutputLimit& row) const {
  if (row.modulus <= 0.0) return 0.0;
  const auto of_drive = configured_object(node_, object(0x607B, 1));
  double lowest = std::isfinite(row.low) ? std::ceil(row.low) : 0.0;
  if (of_drive && turn(configured_object) == row.modulus) lowest = static_cast<double>(*of_drive);
  return std::clamp(lowest, -0x1p31, std::max(-0x1p31, 0x1p31 - row.modulus));
}

/// Warns if the position of the drive wraps at another value than `modulo`. The drive would then
/// move back by a whole turn at once.
void AxisLimits::ask_for_turn(const Sourced<double>& modulo) {
  if (!modulo.given || positions_.empty()) return;
  const double length = modulus(modulo, positions_[0]);
  const double of_drive = turn(configured_object);
  if (of_drive == length) return;
  const ObjectKey key = object(0x607B);
  const std::string text =
      concat("`modulo` of ", owner(), " is ", std::llround(length), " counts of ",
             table_.signal(positions_[0]).name, ", but ", of_drive > 0 ? "" : "nothing sets ", key,
             " (position range limit)",
             of_drive > 0 ? concat(" wraps after ", std::llround(of_drive)) : "",
             ": a drive that doesn't wrap at `modulo` moves back a whole turn at once");
  if (node_.dictionary->find({key.index, 2}) == nullptr) {
    return report_.note(modulo.pos, "limits", text, "; the device file does not have this object");
  }
  report_.warning(modulo.pos, "limits", text, ". Write ", ObjectKey{key.index, 1}, " and ",
                  ObjectKey{key.index, 2}, " under `sdo:`");
}

OutputLimit* AxisLimits::row_of(std::optional<SignalIndex> signal) {
  auto& rows = plan_.limits.outputs;
  const auto found = std::ranges::find_if(
      rows, [&](const OutputLimit& row) { return signal && row.signal == *signal; });
  return found == rows.end() ? nullptr : &*found;
}

/// Connects the row of each target with the row of its offset. Also enters the objects of the mode
/// of operation, which decides whether the axis follows a set-point.
void AxisLimits::describe_rows() {
  const auto describe = [&](AxisQuantity quantity, std::initializer_list<ObjectKey> targets,
                            std::uint16_t offset) {
    const auto added = output(offset);
    if (OutputLimit* const row = row_of(added)) describe_row(*row, quantity);
    for (const SignalIndex target : outputs(targets)) {
      OutputLimit* const row = row_of(target);
      if (row == nullptr) continue;
      describe_row(*row, quantity);
      if (!added || !can_be_added(target, *added)) continue;
      row->offset = added;
      if (OutputLimit* const own = row_of(added)) own->target = target;
    }
  };
  describe(AxisQuantity::position, {{0x607A, 0}, {0x60C1, 1}}, 0x60B0);
  describe(AxisQuantity::velocity, {{0x60FF, 0}}, 0x60B1);
  describe_start(output(0x60FF), input(0x606C));
  describe(AxisQuantity::torque, {{0x6071, 0}}, 0x60B2);
}

void AxisLimits::describe_row(OutputLimit& row, AxisQuantity quantity) const {
  row.quantity = quantity;
  row.mode = output(0x6060);
  row.mode_display = input(0x6061);
  if (!row.mode) row.fixed_mode = configured_object(node_, object(0x6060));
}

/// Enters the actual value from which a set-point may start. The set-point and the actual value
/// must have the same unit.
void AxisLimits::describe_start(std::optional<SignalIndex> target,
                                std::optional<SignalIndex> actual) {
  OutputLimit* const row = row_of(target);
  if (row == nullptr || !actual) return;
  if (table_.signal(*target).scale == table_.signal(*actual).scale) row->feedback = actual;
}

/// Returns false and warns if target and offset have different units.
bool AxisLimits::can_be_added(SignalIndex target, SignalIndex offset) const {
  const Signal& first = table_.signal(target);
  const Signal& second = table_.signal(offset);
  if (first.unit == second.unit) return true;
  report_.warning(node_.spec->pos, "limits", first.name, " and ", second.name, " of ", owner(),
                  " are in ", first.unit, " and ", second.unit,
                  ": takt can't add them, so the limits hold for each of them alone. Give them the "
                  "same unit under `units:`");
  return false;
}

/// Enters the modulus of the positions and the signals that the checks of a position set-point
/// read.
void AxisLimits::describe_position_rows(const AxisLimitsSpec& limits) {
  for (const SignalIndex signal : positions_) {
    OutputLimit* const row = row_of(signal);
    if (row == nullptr) continue;
    row->wraps = !is_real(table_.signal(signal).type);
    row->modulus = modulus(limits.modulo, signal);
    row->lowest = lowest(*row);
    row->controlword = output(0x6040);
    row->feedback = input(0x6064);
    row->statusword = input(0x6041);
  }
}

/// Warns if set-points may be held back for long: a limited set-point waits until the actual
/// position has arrived once, and an event-driven TPDO may never send it at standstill.
void AxisLimits::warn_of_late_start(const AxisLimitsSpec& limits) {
  const std::optional<SignalIndex> feedback = input(0x6064);
  if (positions_.empty() || !feedback) return;
  const PdoRow* const tpdo = tpdo_of(plan_.pdos, *feedback);
  if (tpdo == nullptr || !comes_by_event_alone(*tpdo)) return;
  for (const auto* limit : {&limits.step, &limits.velocity, &limits.acceleration}) {
    if (!limit->given) continue;
    const std::string name = concat("TPDO", tpdo->number);
    return report_.warning(
        limit->pos, "limits", "limits of ", owner(), " hold its set-points back until ",
        object(0x6064), " has arrived once, but ", name, " sends it only by event (transmission ",
        tpdo->transmission,
        " without `event_timer`): an axis at standstill may never send it. Give ", name,
        " an `event_timer`, or make it synchronous (`transmission: 1`)");
  }
}

}  // namespace takt
