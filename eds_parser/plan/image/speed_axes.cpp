#include "eds_parser/plan/image/speed_axes.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <string>

#include "eds_parser/plan/image/signal_rules.hpp"
#include "eds_parser/specification/device_data.hpp"

namespace takt {
namespace {

/// Time to live of the commands to an inverter if the network file states none. An application may
/// stall for this time before the drive stops along its ramp.
constexpr std::chrono::milliseconds speed_time_to_live{500};

class SpeedAxisCompiler {
 public:
  SpeedAxisCompiler(const NodeSource& node, std::size_t index, BusPlan& plan, NetworkReport& report)
      : node_{node}, index_{index}, plan_{plan}, report_{report} {}

  void run() {
    const SpeedAxisSpec& own = node_.spec->speed_axis;
    const SpeedAxisSpec axis = merged(words(), own);
    if (!axis.enabled || (!axis.control && !own.is_stated())) return;
    if (const std::string lack = missing_part(axis); !lack.empty()) {
      report_.error(own.pos, "speed-axis", "`speed_axis` of node `", node_.spec->name, "` lacks ",
                    lack, ", and no device data state it");
      return;
    }
    const auto control_word = signal(*axis.control, true);
    const auto status_word = signal(*axis.status, false);
    const auto set_speed = signal(axis.set_speed->object, true);
    if (!control_word || !status_word || !set_speed) {
      const ObjectKey lack = !control_word  ? *axis.control
                             : !status_word ? *axis.status
                                            : axis.set_speed->object;
      if (!own.is_stated() || node_.spec->has_rpdo_errors) return;
      report_.error(own.pos, "speed-axis", "`speed_axis` of node `", node_.spec->name, "`: no ",
                    control_word && !status_word ? "TPDO" : "RPDO", " carries ", lack);
      return;
    }
    if (!is_integer(*control_word) || !is_integer(*set_speed) || !is_integer(*status_word)) {
      report_.error(own.is_stated() ? own.pos : node_.spec->pos, "speed-axis", "the speed axis `",
                    node_.spec->name, "` needs whole numbers in its words");
      return;
    }
    add(axis, *control_word, *status_word, *set_speed);
  }

 private:
  /// Returns the control word, status word and set speed that the device data state, or those of
  /// the velocity mode (vl) of a CiA 402 drive.
  SpeedAxisSpec words() const {
    if (node_.data != nullptr && node_.data->speed_axis.is_stated()) return node_.data->speed_axis;
    constexpr std::array<std::uint16_t, 4> other_targets{0x607A, 0x60C1, 0x60FF, 0x6071};
    const auto is_output = [&](std::uint16_t index) {
      return std::ranges::any_of(plan_.layout.signals, [&](const Signal& one) {
        return one.node_index == index_ && one.output && one.object.index == index;
      });
    };
    const bool in_velocity_mode = plan_.nodes[index_].cia402 && is_output(0x6042) &&
                                  std::ranges::none_of(other_targets, is_output);
    return in_velocity_mode ? velocity_mode_axis() : SpeedAxisSpec{};
  }

  std::optional<SignalIndex> signal(ObjectKey object, bool output) const {
    return plan_.layout.find(index_, object, output);
  }

  bool is_integer(SignalIndex signal) const {
    const Signal& what = plan_.layout.signals[signal];
    return !is_real(what.type) && what.bits <= 32;
  }

  void add(const SpeedAxisSpec& spec, SignalIndex control_word, SignalIndex status_word,
           SignalIndex set_speed) {
    SpeedAxisPlan axis{.node_index = static_cast<std::uint8_t>(index_),
                       .sequence = spec.sequence.value_or(SpeedSequence::words),
                       .fault_reset = spec.fault_reset.value_or(FaultReset::edge),
                       .control = control_word,
                       .set_speed = set_speed,
                       .status = status_word,
                       .states = spec.states,
                       .unit = spec.set_speed->unit};
    axis.commands = {.mask = spec.commands.mask.value_or(0xFFFF),
                     .off = spec.commands.off.value_or(*spec.commands.stop),
                     .stop = *spec.commands.stop,
                     .run = *spec.commands.run,
                     .run_reverse = spec.commands.run_reverse,
                     .quick_stop = spec.commands.quick_stop,
                     .reset = spec.commands.reset};
    axis.set_scale = scale_of(*spec.set_speed, set_speed, axis.unit);
    if (spec.actual_speed) {
      std::string unit;
      axis.actual_speed = signal(spec.actual_speed->object, false);
      if (axis.actual_speed) {
        axis.actual_scale = scale_of(*spec.actual_speed, *axis.actual_speed, unit);
      }
    }
    stop_when_silent(axis);
    complete_rows(axis);
    plan_.speed_axes.push_back(std::move(axis));
  }

  /// Returns the scale of a speed. If `units:` of the network file gives the object a unit, that
  /// unit and its scale take precedence over `spec`.
  double scale_of(const SpeedValueSpec& spec, SignalIndex signal, std::string& unit) const {
    const Signal& what = plan_.layout.signals[signal];
    if (what.unit.empty() && what.scale == 1.0) return spec.scale;
    unit = what.unit;
    return what.scale;
  }

  /// The master sends an RPDO only when each of its outputs has a value. Other outputs that share
  /// an RPDO with those of the axis therefore begin with 0, so that the first command of a program
  /// is sent at once.
  void complete_rows(const SpeedAxisPlan& axis) {
    const auto& signals = plan_.layout.signals;
    const std::array rows{signals[axis.control].row, signals[axis.set_speed].row};
    for (std::size_t i = plan_.layout.inputs; i < signals.size(); ++i) {
      Signal& one = plan_.layout.signals[i];
      const bool shares = std::ranges::find(rows, one.row) != rows.end();
      const bool is_word = i == axis.control || i == axis.set_speed;
      if (shares && !is_word && !one.safe_value) one.safe_value = 0;
    }
  }

  /// Sets the fallback of the control word and the set speed. Sets the time to live of all outputs
  /// of the node, unless the network file states one.
  void stop_when_silent(const SpeedAxisPlan& axis) {
    // The fallback of a CiA 402 drive is set already.
    if (!plan_.nodes[index_].cia402) set_fallback(axis);
    const TimeoutSpec& timeout = node_.spec->on_timeout;
    if (timeout.after.given || timeout.after_cycles.given) return;
    TimeoutSpec longer;
    longer.after = {static_cast<std::uint32_t>(speed_time_to_live.count()), {}, true};
    for (Signal& one : plan_.layout.signals) {
      if (one.node_index != index_ || !one.output) continue;
      one.fallback_cycles = fallback_cycles(longer, plan_.cycle.period);
    }
  }

  void set_fallback(const SpeedAxisPlan& axis) {
    const TimeoutSpec& timeout = node_.spec->on_timeout;
    const FallbackPolicy policy = timeout.fallback.value_or(FallbackPolicy::quick_stop);
    Signal& command = plan_.layout.signals[axis.control];
    Signal& speed = plan_.layout.signals[axis.set_speed];
    if (policy == FallbackPolicy::quick_stop || policy == FallbackPolicy::disable) {
      command.fallback = speed.fallback = Fallback::value;
      command.fallback_value = axis.commands.stop;
      speed.fallback_value = 0;
    }
    if (policy == FallbackPolicy::disable) command.fallback_value = axis.commands.off;
    if (timeout.fallback.given && policy == FallbackPolicy::quick_stop) {
      command.fallback_value = axis.commands.quick_stop.value_or(axis.commands.stop);
    }
  }

  const NodeSource& node_;
  std::size_t index_;
  BusPlan& plan_;
  NetworkReport& report_;
};

}  // namespace

void compile_speed_axes(std::span<const NodePdos> nodes, BusPlan& plan, NetworkReport& report) {
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    SpeedAxisCompiler{nodes[i].node, i, plan, report}.run();
  }
}

bool has_speed_words(const NodeSource& node) {
  const SpeedAxisSpec& own = node.spec->speed_axis;
  const bool of_family = node.data != nullptr && node.data->speed_axis.is_stated();
  return own.enabled && (own.is_stated() || of_family);
}

}  // namespace takt
