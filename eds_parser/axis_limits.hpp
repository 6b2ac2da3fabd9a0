#pragma once
#include <cstdint>

#include "eds_parser/cob_ids.hpp"
#include "eds_parser/limit_table.hpp"
#include "eds_parser/network_report.hpp"
#include "eds_parser/table/bus_plan.hpp"

namespace takt {

/// `rad/s` of `rad` for a velocity, `rad/s^2` for an acceleration.
bool is_limit_rate(std::string_view unit, const std::string& base, LimitKind kind);

/// Compiles the limits of one axis of a drive: a row for each output that shows them, a line for
/// each kind.
class AxisLimits {
 public:
  AxisLimits(const NodeSource& node, std::size_t node_index, std::uint8_t axis, BusPlan& plan,
             LimitTable& table, NetworkReport& report);

  void compile(const AxisLimitsSpec& limits);

 private:
  ObjectKey object(std::uint16_t first_axis_index, std::uint8_t sub = 0) const;
  std::optional<SignalIndex> output(std::uint16_t index, std::uint8_t sub = 0) const;
  std::optional<SignalIndex> input(std::uint16_t index) const;
  std::vector<SignalIndex> outputs(std::initializer_list<ObjectKey> keys) const;

  void position(const Sourced<RangeSpec>& range);
  void velocity(const Sourced<double>& limit);
  void acceleration(const Sourced<double>& limit);
  void step(const Sourced<double>& limit);
  void torque(const Sourced<double>& limit);
  void jerk(const Sourced<double>& limit);

  // Limits that the drive tells in each boot: axis_device_limits.cpp. False: it has no such object,
  // or no output can be held against it.
  bool device_position();
  bool device_velocity();
  bool device_acceleration();
  /// A readable object of 32 bits.
  bool tells(ObjectKey object) const;
  /// The line that the last limits of the plan belong to.
  LimitLine& device_line(LimitKind kind, ObjectKey object, double scale);
  void read_at_boot(LimitLine& entry, SignalIndex signal, DeviceBound bound, double factor);
  double cycle_seconds() const;

  void magnitude(SignalIndex signal, double si, LimitKind kind, SourcePos pos);
  void describe_position_rows(const AxisLimitsSpec& limits);
  using ObjectReader = std::optional<std::int64_t> (*)(const NodeSource& node, ObjectKey object);
  double turn(ObjectReader read) const;
  double modulus(const Sourced<double>& modulo, SignalIndex signal) const;
  void ask_for_turn(const Sourced<double>& modulo);
  void warn_of_late_start(const AxisLimitsSpec& limits);

  /// False: the signal counts without a unit, which is reported.
  bool has_unit(SignalIndex signal, std::string_view kind, SourcePos pos);
  std::string unit_of(LimitKind kind) const;
  /// The unit of `kind` is that of positions per second, or per second squared.
  bool follows_position(LimitKind kind) const;
  void tell_other_unit(LimitKind kind, SourcePos pos);
  LimitLine& line(LimitKind kind, LimitSource source);
  std::string owner() const;

  const NodeSource& node_;
  std::size_t node_index_;
  std::uint8_t axis_;
  BusPlan& plan_;
  LimitTable& table_;
  NetworkReport& report_;
  std::vector<SignalIndex> positions_;   ///< 607A, 60C1:01
  std::vector<SignalIndex> velocities_;  ///< 60FF, 60B1
};

}  // namespace takt
