#pragma once
#include <optional>
#include <vector>

#include "eds_parser/plan/pdo/effective_pdo.hpp"
#include "eds_parser/report/network_report.hpp"
#include "eds_parser/table/bus_plan.hpp"

namespace takt {

/// The first and the last permitted value in raw counts.
struct RawBounds {
  double low = -OutputLimit::none;
  double high = OutputLimit::none;
};

/// The rows of the limited outputs, one row for each output, during the compilation of a bus.
class LimitTable {
 public:
  LimitTable(BusPlan& plan, NetworkReport& report) : plan_{plan}, report_{report} {}

  const Signal& signal(SignalIndex index) const { return plan_.layout.signals[index]; }
  OutputLimit& row(SignalIndex signal);
  /// Narrows the permitted values of an output. `pos` is the place of the limit in the file.
  void narrow(SignalIndex signal, RawBounds bounds, LimitKind kind, SourcePos pos);

  /// Converts absolute SI values to raw counts. The result is rounded to whole counts if the signal
  /// is an integer.
  RawBounds raw_bounds(SignalIndex signal, std::optional<double> low,
                       std::optional<double> high) const;
  /// Converts a difference or a magnitude to raw counts.
  double raw_size(SignalIndex signal, double si) const;

  /// Sorts the rows by signal. Reports an error if a fallback or a safe value is outside its
  /// limits.
  void finish();

 private:
  BusPlan& plan_;
  NetworkReport& report_;
  std::vector<SourcePos> positions_;  ///< parallel to plan_.limits.outputs
};

}  // namespace takt
