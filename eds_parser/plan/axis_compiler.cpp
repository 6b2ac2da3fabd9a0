#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "eds_parser/plan/image/signal_rules.hpp"
#include "eds_parser/plan/network_parts.hpp"
#include "eds_parser/table/waits.hpp"
#include "eds_parser/values/little_endian.hpp"

namespace takt {
namespace {

constexpr double no_limit = 0x7FFF'FFFF;  // This value and all above it mean "no limit".

/// The numeric values of a device after its boot.
class BootedValues {
 public:
  BootedValues(const NodePlan& node, const DeviceTable& device) {
    for (const DeviceObject& object : device.objects) set(object.key, object.value);
    if (!node.boot) return;
    for (const BootStep& step : node.boot_plan.steps) {
      const bool writes =
          step.action == BootAction::write || step.action == BootAction::write_if_differs;
      if (writes && values_.contains(step.object)) set(step.object, step.value);
    }
  }
  bool has(ObjectKey key) const { return values_.contains(key); }
  std::optional<std::uint32_t> get(ObjectKey key) const {
    const auto found = values_.find(key);
    return found == values_.end() ? std::nullopt : std::optional{found->second};
  }
  /// Returns std::nullopt if the object is missing, is zero, or has a value that means "no limit".
  std::optional<double> positive(ObjectKey key) const {
    const auto value = get(key);
    if (!value || *value == 0 || *value >= no_limit) return std::nullopt;
    return *value;
  }

 private:
  void set(ObjectKey key, const std::vector<std::byte>& bytes) {
    if (bytes.empty() || bytes.size() > 4) return;
    values_[key] = static_cast<std::uint32_t>(from_little_endian(bytes));
  }

  std::map<ObjectKey, std::uint32_t> values_;
};

class AxisCompiler {
 public:
  AxisCompiler(const BootedValues& values, const NodeSpec& spec, std::uint8_t number)
      : values_{values}, units_{spec.units}, limits_{spec.limits}, number_{number} {}

  AxisPlan run() const {
    AxisPlan axis{.number = number_, .quick_stop_option = option()};
    const auto limit = velocity_limit();
    const std::uint16_t ramp = ramp_object(axis.quick_stop_option);
    const auto deceleration = ramp == 0 ? std::nullopt : values_.positive(at(ramp));
    if (limit && deceleration) {
      axis.ramp_object = ramp;
      axis.stopping_time = seconds(*limit / (*deceleration * acceleration_ratio()));
    }
    if (const auto window = standstill_velocity(limit)) set_windows(axis, *window);
    return axis;
  }
  /// Returns true if no known value of this axis determines its standstill windows.
  bool windows_are_guessed() const { return !standstill_velocity(velocity_limit()); }

 private:
  ObjectKey at(unsigned index, std::uint8_t sub = 0) const {
    return axis_object(number_, index, sub);
  }

  static Time seconds(double value) {
    constexpr double longest = 86'400;
    return Time{static_cast<Time::rep>(std::min(value, longest) * 1e9)};
  }

  /// Returns the quick stop option code (0x605A), or 2 if no value of it is known.
  std::int16_t option() const {
    return static_cast<std::int16_t>(values_.get(at(0x605A)).value_or(2));
  }

  /// Returns the object that holds the deceleration of a quick stop, or 0 if the axis does not stop
  /// along a known ramp.
  static std::uint16_t ramp_object(std::int16_t option) {
    if (option == 1 || option == 5) return 0x6084;
    return option == 2 || option == 6 ? 0x6085 : 0;
  }

  /// Returns the number of velocity units that one acceleration unit adds in a second.
  double acceleration_ratio() const { return in_velocities(units_.acceleration); }
  double positions_in_velocity() const { return in_velocities(units_.position); }
  double in_velocities(const std::optional<UnitSpec>& unit) const {
    return unit && units_.velocity ? *unit->scale / *units_.velocity->scale : 1;
  }

  /// Returns the velocity limit of the axis in units of 0x606C. It is the lowest of 0x607F, of
  /// 0x6080 (motor revolutions per minute) converted through the gear, and of the limit that the
  /// network file sets for commands.
  std::optional<double> velocity_limit() const {
    std::optional<double> lowest = values_.positive(at(0x607F));
    const auto take = [&](double limit) { lowest = std::min(lowest.value_or(limit), limit); };
    const auto motor = values_.positive(at(0x6080));
    const auto per_turn = positions_per_turn();
    if (motor && per_turn) take(*motor / 60 * *per_turn * positions_in_velocity());
    if (const auto commanded = commanded_velocity()) take(*commanded);
    return lowest;
  }

  /// Returns `limits: {velocity}` of the network file in units of 0x606C.
  std::optional<double> commanded_velocity() const {
    Sourced<double> velocity = limits_.all.velocity;
    for (const AxisOverrideSpec& own : limits_.axes) {
      if (own.axis == number_ + 1 && own.limits.velocity.given) velocity = own.limits.velocity;
    }
    if (!velocity.given || *velocity <= 0) return std::nullopt;
    const auto& unit = units_.velocity ? units_.velocity : units_.position;
    return *velocity / (unit ? std::abs(*unit->scale) : 1.0);
  }

  /// Returns the number of position units for each revolution of the motor: 0x6092 divided by
  /// 0x6091, else 0x608F.
  std::optional<double> positions_per_turn() const {
    if (const auto feed = ratio(0x6092)) return *feed / ratio(0x6091).value_or(1);
    return ratio(0x608F);
  }

  std::optional<double> ratio(std::uint16_t index) const {
    const auto above = values_.positive(at(index, 1));
    const auto below = values_.positive(at(index, 2));
    if (!above || !below) return std::nullopt;
    return *above / *below;
  }

  /// Returns the velocity below which an axis counts as standing still, in units of 0x606C. If the
  /// axis has a velocity limit, the result is the velocity threshold of the device (0x606F), but at
  /// most a hundredth of the limit; without a threshold it is a thousandth of the limit. If the
  /// axis has no limit, the result is the threshold. If both are missing, the result is a hundredth
  /// of a revolution of the motor per second. If the gear is unknown too, it is the velocity that
  /// crosses the position window of the device (0x6067) in 50 ms, or else a velocity that is small
  /// in the position unit of the network file.
  std::optional<double> standstill_velocity(std::optional<double> limit) const {
    const auto threshold = values_.positive(at(0x606F));
    if (limit && threshold) return std::min(*threshold, *limit / 100);
    if (limit) return *limit / 1000;
    if (threshold) return threshold;
    if (const auto turn = positions_per_turn()) return *turn / 100 * positions_in_velocity();
    if (const auto window = values_.positive(at(0x6067))) {
      return *window * looks_in_a_second * positions_in_velocity();
    }
    return small_in_unit();
  }

  std::optional<double> small_in_unit() const {
    struct Small {
      std::string_view unit;
      double in_a_second;
    };
    static constexpr std::array<Small, 5> small{
        {{"m", 1e-3}, {"mm", 1.0}, {"rad", 1e-2}, {"deg", 0.5}, {"°", 0.5}}};
    if (!units_.position) return std::nullopt;
    const auto* const found = std::ranges::find(small, units_.position->unit, &Small::unit);
    if (found == small.end()) return std::nullopt;
    return found->in_a_second / std::abs(*units_.position->scale) * positions_in_velocity();
  }

  void set_windows(AxisPlan& axis, double window) const {
    constexpr double most = 1e9;
    axis.velocity_window = std::max<std::int64_t>(1, std::llround(std::min(window, most)));
    const double travel = window / positions_in_velocity() / looks_in_a_second;
    axis.position_window = std::max<std::int64_t>(2, std::llround(std::min(travel, most)));
  }

  // This is the reciprocal of Standstill::standstill_time (50 ms), in 1/s.
  static constexpr double looks_in_a_second = 20;

  const BootedValues& values_;
  const UnitsSpec& units_;
  const LimitsSpec& limits_;
  std::uint8_t number_;
};

std::optional<HomingPlan> homing_of(const HomingSpec& spec, std::uint8_t number) {
  if (!spec.given) return std::nullopt;
  const AxisHomingSpec homing = spec.of(static_cast<std::uint8_t>(number + 1));
  HomingPlan plan{.required = *homing.required};
  if (homing.timeout.given) plan.timeout = std::chrono::milliseconds{*homing.timeout};
  if (homing.method.given) plan.method = *homing.method;
  return plan;
}

std::optional<FeedForwardPlan> feed_forward_of(const FeedForwardSpec& spec, std::uint8_t number) {
  const AxisFeedForwardSpec found = spec.of(static_cast<std::uint8_t>(number + 1));
  if (!found.torque_per_acceleration.given && !found.torque_per_velocity.given) return std::nullopt;
  return FeedForwardPlan{.torque_per_acceleration = *found.torque_per_acceleration,
                         .torque_per_velocity = *found.torque_per_velocity};
}

/// Returns the unit that `units:` gives to an object of an axis.
RawUnit unit_of(const NodeSource& source, std::uint8_t number, unsigned index) {
  Signal signal{.node = source.id, .object = axis_object(number, index)};
  apply_units(source, signal);
  return {.scale = signal.scale, .unit = signal.unit};
}

std::string seconds_text(Time time) {
  const auto tenths = (time + std::chrono::milliseconds{99}) / std::chrono::milliseconds{100};
  return concat(tenths / 10, ".", tenths % 10, " s");
}

std::string axis_name(const NodePlan& node, const AxisPlan& axis) {
  return concat("`", node.name, "`",
                axis.number == 0 ? "" : concat(" (axis ", axis.number + 1, ")"));
}

void report_guess(const NodePlan& node, const AxisPlan& axis, const NodeSpec& spec,
                  NetworkReport& report) {
  report.note(spec.pos, "standstill", "drive ", axis_name(node, axis),
              " has no velocity threshold (606F) and no velocity limit (607F, 6080): the ordered "
              "stop treats up to ",
              axis.velocity_window,
              " raw units of 606C as standstill; write `limits: {velocity: ...}`, and a thousandth "
              "of this limit applies instead");
}

}  // namespace

std::vector<AxisPlan> compile_axes(const NodePlan& node, const DeviceTable& device,
                                   const NodeSource& source, NetworkReport& report) {
  const NodeSpec& spec = *source.spec;
  std::vector<AxisPlan> axes;
  if (!node.cia402) return axes;
  const BootedValues values{node, device};
  for (std::uint8_t number = 0; number < most_axes; ++number) {
    if (!values.has(axis_object(number, 0x6040))) continue;
    const AxisCompiler axis{values, spec, number};
    axes.push_back(axis.run());
    axes.back().velocity_unit = unit_of(source, number, 0x606C);
    axes.back().position_unit = unit_of(source, number, 0x6064);
    axes.back().homing = homing_of(spec.homing, number);
    axes.back().feed_forward = feed_forward_of(spec.feed_forward, number);
    if (axis.windows_are_guessed()) report_guess(node, axes.back(), spec, report);
  }
  return axes;
}

Time longest_stopping_time(const BusPlan& plan) noexcept {
  Time longest{};
  for (const NodePlan& node : plan.nodes) {
    for (const AxisPlan& axis : node.axes) longest = std::max(longest, axis.stopping_time);
  }
  return longest;
}

void judge_stop(const BusPlan& plan, const NetworkSpec& spec, NetworkReport& report) {
  const Time given = waits::stop_limits(plan.stop_timeout, plan.cycle.period).quick_stop;
  for (const NodePlan& node : plan.nodes) {
    const auto source = std::ranges::find(spec.nodes, node.name, &NodeSpec::name);
    const SourcePos pos = source == spec.nodes.end() ? SourcePos{} : source->pos;
    for (const AxisPlan& axis : node.axes) {
      if (axis.quick_stop_option == 0) {
        report.warning(pos, "stop-time", "drive ", axis_name(node, axis),
                       " coasts in an ordered stop (605A:00 is 0): taktd never sees the drive at "
                       "standstill before it disables the drive, and ends with exit code 6; write "
                       "`sdo: [{index: 0x605A, value: 2}]` for a ramp");
      }
      if (axis.stopping_time <= given) continue;
      const Time needed = axis.stopping_time * 5 / 4 * 10 / 8;
      const auto ms = (needed + std::chrono::milliseconds{99}) / std::chrono::milliseconds{100};
      const std::string ramp = hex(axis_object(axis.number, axis.ramp_object).index).substr(2);
      const bool possible = needed <= std::chrono::seconds{60};
      report.warning(
          pos, "stop-time", "drive ", axis_name(node, axis), " needs ",
          seconds_text(axis.stopping_time),
          " to stop from its velocity limit (607F, 6080, `limits:`) along the ramp ", ramp,
          ":00; the ordered stop waits ", seconds_text(given),
          " and then disables the drive while it moves. ",
          possible ? concat("Write `master: {stop_timeout: ", ms * 100, "}`, or a steeper ramp")
                   : "Write a steeper ramp",
          " (`sdo: [{index: 0x", ramp, ", value: ...}]`)");
    }
  }
}

}  // namespace takt
