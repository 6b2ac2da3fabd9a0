#pragma once
#include <cstdint>

#include "eds_parser/plan/limits/limit_table.hpp"
#include "eds_parser/plan/pdo/cob_ids.hpp"
#include "eds_parser/report/network_report.hpp"
#include "eds_parser/table/bus_plan.hpp"

namespace takt {

/// Returns true if `unit` is the rate of `base` that suits `kind`: for the base `rad` this is
/// `rad/s` for a velocity and `rad/s^2` for an acceleration.
bool is_limit_rate(std::string_view unit, const std::string& base, LimitKind kind);

/// Compiles the limits of one axis of a drive. The result is one row for each output that a limit
/// applies to, and one line for each kind of limit.
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

  // These functions compile limits that are read from the drive in each boot; see
  // axis_device_limits.cpp. They return false if the drive has no such object, or if no output can
  // be compared with the limit.
  bool device_position();
  bool device_velocity();
  bool device_acceleration();
  /// Returns true if the object is a readable integer of 32 bits.
  bool reports(ObjectKey object) const;
  /// Appends the line for a limit that is read from the drive. Limits that are added to the plan
  /// afterwards refer to this line.
  LimitLine& device_line(LimitKind kind, ObjectKey object, double scale);
  void read_at_boot(LimitLine& entry, SignalIndex signal, DeviceBound bound, double factor);
  double cycle_seconds() const;

  void add_offset(LimitLine& entry) const;
  // These functions limit one output by the value of `entry`, as a magnitude or as a rate.
  void magnitude(LimitLine& entry, SignalIndex signal, SourcePos pos);
  void rate(LimitLine& entry, SignalIndex signal);
  /// Returns nullptr if there is no output, or if it has no limits.
  OutputLimit* row_of(std::optional<SignalIndex> signal);
  void describe_rows();
  void describe_row(OutputLimit& row, AxisQuantity quantity) const;
  void describe_start(std::optional<SignalIndex> target, std::optional<SignalIndex> actual);
  bool can_be_added(SignalIndex target, SignalIndex offset) const;
  void describe_position_rows(const AxisLimitsSpec& limits);
  using ObjectReader = std::optional<std::int64_t> (*)(const NodeSource& node, ObjectKey object);
  double turn(ObjectReader read) const;
  double modulus(const Sourced<double>& modulo, SignalIndex signal) const;
  double lowest(const OutputLimit& row) const;
  void ask_for_turn(const Sourced<double>& modulo);
  void warn_of_late_start(const AxisLimitsSpec& limits);

  /// Returns false and reports an error if the signal has no unit, so that the limit would apply to
  /// raw counts.
  bool has_unit(SignalIndex signal, LimitKind kind, SourcePos pos);
  std::string unit_of(LimitKind kind) const;
  /// Returns true if the unit of `kind` is the unit of positions per second, or per second squared.
  /// Also returns true if the axis has no position output.
  bool follows_position(LimitKind kind) const;
  /// Returns the result of follows_position(). If it is false, warns that the limit can't be
  /// compared with positions.
  bool is_comparable(LimitKind kind, SourcePos pos);
  LimitLine& line(LimitKind kind, LimitSource source);
  /// Appends the line of a limit of the network file and returns it. Returns nullptr if the file
  /// has no such limit; the plan then shows a line without a limit if `shown` is true.
  LimitLine* line_of_file(LimitKind kind, const Sourced<double>& limit, bool shown);
  std::string owner() const;

  const NodeSource& node_;
  std::size_t node_index_;
  std::uint8_t axis_;
  BusPlan& plan_;
  LimitTable& table_;
  NetworkReport& report_;
  std::vector<SignalIndex> positions_;   ///< outputs 607A and 60C1:01
  std::vector<SignalIndex> velocities_;  ///< outputs 60FF and 60B1
  std::vector<SignalIndex> torques_;     ///< outputs 6071 and 60B2
};

}  // namespace takt
