#include "eds_parser/plan/device/device_mechanics.hpp"

#include <algorithm>
#include <numbers>
#include <optional>

#include "eds_parser/dictionary/integer_of.hpp"

namespace takt {
namespace {

constexpr double default_turn = 65536;  // counts, if nothing is known about the axis

/// Returns the value of sub-index 1 divided by that of sub-index 2, as the object has them after
/// the boot. Returns std::nullopt unless both are above zero.
std::optional<double> quotient(const NodeSource& node, std::uint16_t index) {
  const auto value = [&](std::uint8_t sub) {
    const ObjectKey key{index, sub};
    const std::int64_t* const written = node.spec->written_integer(key);
    return written != nullptr ? *written : integer_of(*node.dictionary, key).value_or(0);
  };
  const std::int64_t numerator = value(1);
  const std::int64_t denominator = value(2);
  if (numerator <= 0 || denominator <= 0) return std::nullopt;
  return static_cast<double>(numerator) / static_cast<double>(denominator);
}

/// Returns the length of one turn of the shaft in the unit of the position, or std::nullopt if this
/// unit is not a unit of angles.
std::optional<double> full_turn(const std::string& unit) {
  if (unit == "rad") return 2 * std::numbers::pi;
  return unit == "deg" ? std::optional{360.0} : std::nullopt;
}

/// Returns the number of position counts in one turn of the motor.
double counts_per_turn(const NodeSource& node, double turn) {
  const auto& unit = node.spec->units.position;
  const double scale = unit ? *unit->scale : 1;
  if (turn > 0) return turn / scale;
  if (const auto full = unit ? full_turn(unit->unit) : std::nullopt) return *full / scale;
  const auto feed = quotient(node, 0x6092);
  return feed ? *feed / quotient(node, 0x6091).value_or(1) : default_turn;
}

/// Converts positions to counts.
class Counts {
 public:
  explicit Counts(const std::optional<UnitSpec>& unit) {
    if (unit) unit_ = *unit;
  }
  void convert(std::optional<double>& position) const {
    if (position) position = of(*position);
  }
  void convert(std::optional<ZoneParameters>& zone) const {
    if (!zone) return;
    const double low = of(zone->low);
    const double high = of(zone->high);
    zone = ZoneParameters{std::min(low, high), std::max(low, high)};
  }

 private:
  double of(double position) const { return unit_.sign * (position - unit_.offset) / *unit_.scale; }

  UnitSpec unit_;
};

}  // namespace

MechanicsTable compile_mechanics(const NodeSource& node) {
  MechanicsTable table = *node.spec->sim.mechanics;
  table.turn = counts_per_turn(node, table.turn);
  const Counts counts{node.spec->units.position};
  auto& [stops, switches, home, probe_1, probe_2, index] = table.travel;
  for (auto* zone : {&stops, &switches, &home, &probe_1, &probe_2}) counts.convert(*zone);
  counts.convert(index);
  return table;
}

}  // namespace takt
