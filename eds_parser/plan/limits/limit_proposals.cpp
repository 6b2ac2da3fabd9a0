#include "eds_parser/plan/limits/limit_proposals.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <string>
#include <utility>

#include "eds_parser/dictionary/integer_of.hpp"
#include "eds_parser/plan/device/node_objects.hpp"
#include "eds_parser/table/output_limits.hpp"

namespace takt {
namespace {

std::string number(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.4g", value);
  return text.data();
}

class Proposal {
 public:
  Proposal(LimitLine& line, const NodeSource& node, const BusPlan& plan, const LimitTable& table)
      : line_{line}, node_{node}, plan_{plan}, table_{table} {}

  void make() {
    switch (line_.kind) {
      case LimitKind::position:
        return position();
      case LimitKind::velocity:
        return quantity(LimitKind::velocity, {0x607F, 0x6081}, node_.spec->units.velocity);
      case LimitKind::acceleration:
        return quantity(LimitKind::acceleration, {0x60C5, 0x6083}, node_.spec->units.acceleration);
      case LimitKind::torque:
        return quantity(LimitKind::torque, {0x6072, 0x6072}, node_.spec->units.torque);
      case LimitKind::step:
        return step();
      case LimitKind::jerk:
      case LimitKind::range:
      case LimitKind::following_error:
        return;
    }
  }

 private:
  ObjectKey object(std::uint16_t index, std::uint8_t sub = 0) const {
    return axis_object(line_.axis - 1U, index, sub);
  }

  void words(const std::string& because) {
    line_.proposal = std::string{name(line_.kind)} + ": ...";
    line_.because = because;
  }

  void position() {
    const auto signal = plan_.layout.find(line_.node_index, object(0x607A), true);
    const auto low = configured_object(node_, object(0x607D, 1));
    const auto high = configured_object(node_, object(0x607D, 2));
    if (!signal || table_.signal(*signal).unit.empty()) return words("give positions a unit first");
    if (!low || !high || !plausible_range(*low, *high))
      return words("enter the travel of the machine");
    const Signal& what = table_.signal(*signal);
    const auto end = [&](std::int64_t raw) {
      return open_end(raw) ? "..." : number(static_cast<double>(raw) * what.scale + what.offset);
    };
    std::string first = end(*low);
    std::string last = end(*high);
    if (what.scale < 0) std::swap(first, last);
    line_.proposal = "position: [" + first + ", " + last + "]";
    line_.because = "607D";
  }

  void quantity(LimitKind kind, std::array<std::uint16_t, 2> indices,
                const std::optional<UnitSpec>& unit) {
    if (!unit)
      return words("give it a unit first, then enter the highest value that the machine permits");
    for (const std::uint16_t index : indices) {
      const auto value = configured_object(node_, object(index));
      if (!value || !plausible_size(*value)) continue;
      line_.proposal =
          std::string{name(kind)} + ": " + number(static_cast<double>(*value) * *unit->scale);
      line_.because = to_string(object(index));
      return;
    }
    words("enter the highest value that the machine permits");
  }

  /// Proposes the distance that the axis travels in one cycle at its velocity limit.
  void step() {
    const double seconds = std::chrono::duration<double>(plan_.cycle.period).count();
    for (const LimitLine& other : plan_.limits.lines) {
      const bool mine = other.node_index == line_.node_index && other.axis == line_.axis;
      if (!mine || other.kind != LimitKind::velocity || !other.high) continue;
      line_.proposal = "step: " + number(*other.high * seconds);
      line_.because = "velocity in one cycle";
      return;
    }
    words("enter the distance in one cycle at full speed");
  }

  LimitLine& line_;
  const NodeSource& node_;
  const BusPlan& plan_;
  const LimitTable& table_;
};

/// Returns the limits of the device file in raw counts. The result is empty if one of them is
/// missing or if they permit all values of the data type.
std::optional<std::pair<double, double>> file_range(const SubObject& sub, unsigned bits) {
  const auto low = integer_of(sub.low_limit);
  const auto high = integer_of(sub.high_limit);
  if (!low || !high || *low >= *high) return std::nullopt;
  const double values = std::exp2(bits);
  const double permitted = static_cast<double>(*high) - static_cast<double>(*low) + 1.0;
  if (permitted >= values - 1.0) return std::nullopt;  // Some files leave out one of the two ends.
  return std::pair{static_cast<double>(*low), static_cast<double>(*high)};
}

}  // namespace

void propose_range(LimitLine& line, const Signal& output, const NodeSource& node) {
  std::string low = "...";
  std::string high = "...";
  line.because = "if it is a number, enter what the machine permits; a bit field needs no limits";
  const SubObject* const sub = node.dictionary->find(output.object);
  if (const auto range = sub == nullptr ? std::nullopt : file_range(*sub, output.bits)) {
    const double first = range->first * output.scale + output.offset;
    const double last = range->second * output.scale + output.offset;
    low = number(std::min(first, last));
    high = number(std::max(first, last));
    line.because = "LowLimit and HighLimit of the device file";
  }
  const std::string sub_index =
      output.object.sub == 0 ? "" : ", sub_index: " + std::to_string(output.object.sub);
  line.proposal = "objects: [{index: " + hex(output.object.index) + sub_index + ", min: " + low +
                  ", max: " + high + "}]";
}

void propose_limit(LimitLine& line, const NodeSource& node, const BusPlan& plan,
                   const LimitTable& table) {
  if (line.source != LimitSource::none) return;
  Proposal{line, node, plan, table}.make();
}

}  // namespace takt
