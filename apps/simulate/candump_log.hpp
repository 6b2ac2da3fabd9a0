#pragma once
#include <fstream>
#include <string>

#include "apps/simulate/wire_statistics.hpp"
#include "master/sim/wire_frame.hpp"

namespace takt {

/// Counts what is on the wire and, where a file is named, writes it as `candump -L` does.
class CandumpLog final : public sim::BusObserver {
 public:
  /// Throws std::runtime_error where the file can't be written.
  CandumpLog(const BusPlan& plan, const std::string& path);

  void on_wire(const sim::WireFrame& wire) noexcept override;
  const WireStatistics& statistics() const noexcept { return statistics_; }

 private:
  WireStatistics statistics_;
  std::string bus_;
  std::ofstream file_;
};

}  // namespace takt
