#pragma once
#include <fstream>
#include <string>

#include "apps/takt/simulate/wire_statistics.hpp"
#include "master/sim/bus/wire_frame.hpp"

namespace takt {

/// Counts the frames on the wire and, if a file is named, writes them as `candump -L` does.
class CandumpLog final : public sim::BusObserver {
 public:
  /// An empty `path` means no file. Throws std::runtime_error if the file cannot be written.
  CandumpLog(const BusPlan& plan, const std::string& path);

  void on_wire(const sim::WireFrame& wire) noexcept override;
  const WireStatistics& statistics() const noexcept { return statistics_; }

 private:
  [[gnu::noinline]] void write(const sim::WireFrame& wire) noexcept;

  WireStatistics statistics_;
  std::string bus_;
  std::ofstream file_;
  bool writes_ = false;  ///< `file_` is open
};

}  // namespace takt
