#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "eds_parser/effective_pdo.hpp"
#include "eds_parser/network_report.hpp"
#include "eds_parser/table/bus_plan.hpp"

namespace takt {

/// The first and the last value of a bound in raw counts.
struct RawRange {
  double low = -OutputLimit::none;
  double high = OutputLimit::none;
};

/// One row for each limited output while the limits of a bus are compiled.
class LimitTable {
 public:
  LimitTable(BusPlan& plan, NetworkReport& report) : plan_{plan}, report_{report} {}

  /// None: the PDOs of the node carry no such object in this direction.
  std::optional<SignalIndex> find(std::size_t node_index, ObjectKey object, bool output) const;
  const Signal& signal(SignalIndex index) const { return plan_.layout.signals[index]; }
  OutputLimit& row(SignalIndex signal);
  /// Narrows what may be sent. `pos`: where the file says so.
  void narrow(SignalIndex signal, RawRange range, LimitKind kind, SourcePos pos);

  /// Raw counts of SI values that are absolute; whole where the signal is an integer.
  RawRange raw_range(SignalIndex signal, std::optional<double> low,
                     std::optional<double> high) const;
  /// Raw counts of a difference or a magnitude.
  double raw_size(SignalIndex signal, double si) const;

  /// Sorted by signal; a fallback or a safe value outside its limits is an error.
  void finish();

 private:
  BusPlan& plan_;
  NetworkReport& report_;
  std::vector<SourcePos> positions_;  ///< beside plan_.limits.outputs
};

}  // namespace takt
