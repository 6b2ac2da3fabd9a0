#include "eds_parser/plan/limits/limits_compiler.hpp"

#include <algorithm>
#include <array>
#include <set>
#include <string>

#include "eds_parser/plan/limits/axis_limits.hpp"
#include "eds_parser/plan/limits/limit_proposals.hpp"
#include "eds_parser/plan/limits/limit_table.hpp"
#include "eds_parser/plan/limits/speed_limits.hpp"

namespace takt {
namespace {

/// The limits of an axis that are single numbers.
constexpr std::array<Sourced<double> AxisLimitsSpec::*, 7> numbers{
    &AxisLimitsSpec::velocity,        &AxisLimitsSpec::acceleration, &AxisLimitsSpec::jerk,
    &AxisLimitsSpec::following_error, &AxisLimitsSpec::step,         &AxisLimitsSpec::torque,
    &AxisLimitsSpec::modulo};

/// Replaces each limit that `own` also states by the value in `own`.
void override_limits(AxisLimitsSpec& limits, const AxisLimitsSpec& own) {
  if (own.position.given) limits.position = own.position;
  for (const auto member : numbers) {
    if ((own.*member).given) limits.*member = own.*member;
  }
}

/// Returns the place of the first limit of an axis, or std::nullopt if there is none.
std::optional<SourcePos> first_place(const AxisLimitsSpec& limits) {
  if (limits.position.given) return limits.position.pos;
  for (const auto member : numbers) {
    if ((limits.*member).given) return (limits.*member).pos;
  }
  return std::nullopt;
}

/// Returns true if the device file calls the object a control word or a bit field. The data type
/// does not distinguish a bit field from a number, and only CiA 402 defines an index for the
/// control word.
bool has_name_of_bits(const Signal& output) {
  constexpr std::array<std::string_view, 3> names{"control_word", "controlword", "bit_field"};
  return std::ranges::any_of(
      names, [&](std::string_view name) { return output.name.find(name) != std::string::npos; });
}

class LimitsCompiler {
 public:
  LimitsCompiler(std::span<const NodePdos> nodes, BusPlan& plan, NetworkReport& report)
      : nodes_{nodes}, plan_{plan}, report_{report}, table_{plan, report} {}

  void run() {
    for (std::size_t i = 0; i < nodes_.size(); ++i) node(i);
    table_.finish();
  }

 private:
  void node(std::size_t index) {
    const NodeSource& source = nodes_[index].node;
    const LimitsSpec& limits = source.spec->limits;
    const std::set<std::uint8_t> axes = axes_of(index);
    const bool complete = every_output_is_mapped(nodes_[index]);
    SpeedAxisPlan* const speed = speed_axis(index);
    if (speed != nullptr) compile_speed_limits(*source.spec, *speed, plan_, table_, report_);
    for (const AxisOverrideSpec& own : limits.axes) {
      if (axes.contains(own.axis) || !complete) continue;
      report_.error(own.pos, "limits", "no RPDO of node `", source.spec->name,
                    "` carries a set-point of axis ", own.axis);
    }
    const auto place = first_place(limits.all);
    if (place && axes.empty() && speed == nullptr && complete) {
      report_.error(*place, "limits", "no RPDO of node `", source.spec->name,
                    "` carries a set-point of a drive (607A, 60FF, 6071 ...): write the limits of "
                    "other outputs under `objects: [{index: ..., min: ..., max: ...}]`");
    }
    for (const std::uint8_t axis : axes) {
      AxisLimitsSpec own = limits.all;
      for (const AxisOverrideSpec& entry : limits.axes) {
        if (entry.axis == axis) override_limits(own, entry.limits);
      }
      AxisLimits{source, index, axis, plan_, table_, report_}.compile(own);
    }
    for (const ObjectLimitSpec& limit : limits.objects) object(index, limit);
    propose_ranges(index);
  }

  /// Returns nullptr if the node is no speed axis.
  SpeedAxisPlan* speed_axis(std::size_t node_index) {
    const auto found = std::ranges::find(plan_.speed_axes, node_index, &SpeedAxisPlan::node_index);
    return found == plan_.speed_axes.end() ? nullptr : &*found;
  }

  /// Adds a line with a proposal for each output of the node that needs a limit and has none; see
  /// needs_range().
  void propose_ranges(std::size_t node_index) {
    const auto& signals = plan_.layout.signals;
    for (std::size_t i = plan_.layout.inputs; i < signals.size(); ++i) {
      const Signal& output = signals[i];
      if (output.node_index != node_index || !needs_range(output)) continue;
      const SpeedAxisPlan* const axis = speed_axis(node_index);
      if (axis != nullptr &&
          (i == axis->control || (i == axis->set_speed && axis->max_speed > 0))) {
        continue;
      }
      LimitLine line{.node_index = static_cast<std::uint8_t>(node_index),
                     .object = output.object,
                     .unit = output.unit};
      propose_range(line, output, nodes_[node_index].node);
      plan_.limits.lines.push_back(std::move(line));
    }
  }

  /// Returns false for bits, control words and digital outputs (CiA 401), and for the objects of a
  /// drive, whose limits are those of its axis.
  bool needs_range(const Signal& output) const {
    const std::uint16_t index = output.object.index;
    const bool of_axis = plan_.nodes[output.node_index].cia402 && index >= 0x6000 && index < 0xA000;
    const bool digital =
        output.bits <= 8 || (index >= 0x6200 && index < 0x6400) || has_name_of_bits(output);
    const auto limits_it = [&](const LimitLine& line) {
      return line.node_index == output.node_index && line.axis == 0 && line.object == output.object;
    };
    return !of_axis && !digital && std::ranges::none_of(plan_.limits.lines, limits_it);
  }

  /// Returns false if an RPDO has errors. These errors are already reported, so a limit without an
  /// output is not reported as a second error.
  static bool every_output_is_mapped(const NodePdos& node) {
    const auto is_mapped = [&](const PdoSpec& written) {
      if (!*written.enabled) return true;
      const auto pdo = std::ranges::find_if(node.pdos, [&](const EffectivePdo& one) {
        return !one.is_tpdo && one.number == written.number;
      });
      if (pdo == node.pdos.end() || pdo->bits > 64) return false;
      return !written.mapping.given || pdo->mapping.size() >= written.mapping->size();
    };
    const NodeSpec& spec = *node.node.spec;
    return !spec.has_rpdo_errors && std::ranges::all_of(spec.rpdos, is_mapped);
  }

  /// Returns the axes that have a set-point in an RPDO.
  std::set<std::uint8_t> axes_of(std::size_t node_index) const {
    constexpr std::array<std::uint16_t, 7> set_points{0x607A, 0x60C1, 0x60FF, 0x6071,
                                                      0x60B0, 0x60B1, 0x60B2};
    std::set<std::uint8_t> axes;
    if (!plan_.nodes[node_index].cia402) return axes;
    for (const Signal& signal : plan_.layout.signals) {
      const std::uint16_t index = signal.object.index;
      if (signal.node_index != node_index || !signal.output || index < 0x6000 || index >= 0xA000) {
        continue;
      }
      const auto first = static_cast<std::uint16_t>(0x6000 + index % 0x800);
      if (std::ranges::find(set_points, first) == set_points.end()) continue;
      axes.insert(static_cast<std::uint8_t>((index - 0x6000) / 0x800 + 1));
    }
    return axes;
  }

  void object(std::size_t node_index, const ObjectLimitSpec& limit) {
    const auto signal = plan_.layout.find(node_index, limit.object, true);
    if (!signal) {
      if (!every_output_is_mapped(nodes_[node_index])) return;
      report_.error(limit.pos, "limits", "`limits` of node `", plan_.nodes[node_index].name,
                    "`: no RPDO carries ", limit.object, ", so no command can contain this object");
      return;
    }
    const auto add = [&](LimitKind kind, const Sourced<double>& low, const Sourced<double>& high) {
      const auto bound = [](const Sourced<double>& value) {
        return value.given ? std::optional{*value} : std::nullopt;
      };
      return plan_.limits.lines.emplace_back(
          LimitLine{.node_index = static_cast<std::uint8_t>(node_index),
                    .object = limit.object,
                    .kind = kind,
                    .source = LimitSource::file,
                    .low = bound(low),
                    .high = bound(high),
                    .unit = table_.signal(*signal).unit,
                    .signals = {*signal}});
    };
    if (limit.min.given || limit.max.given) {
      const LimitLine line = add(LimitKind::range, limit.min, limit.max);
      table_.narrow(*signal, table_.raw_bounds(*signal, line.low, line.high), LimitKind::range,
                    limit.pos);
    }
    if (!limit.step.given) return;
    OutputLimit& row = table_.row(*signal);
    row.step = std::min(row.step, table_.raw_size(*signal, *limit.step));
    add(LimitKind::step, {}, limit.step);
  }

  std::span<const NodePdos> nodes_;
  BusPlan& plan_;
  NetworkReport& report_;
  LimitTable table_;
};

}  // namespace

void compile_limits(std::span<const NodePdos> nodes, BusPlan& plan, NetworkReport& report) {
  LimitsCompiler{nodes, plan, report}.run();
}

}  // namespace takt
