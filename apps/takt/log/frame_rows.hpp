#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "apps/takt/log/log_writer.hpp"
#include "eds_parser/table/bus_plan.hpp"
#include "master/wire/frame.hpp"

namespace takt::logging {

/// Makes rows from recorded frames. A row has the values of the PDOs between one SYNC and the next
/// one. Cycles are counted from the first SYNC. On a bus without SYNC, a row covers one period.
/// Multiplexed PDOs are left out.
class FrameRows {
 public:
  FrameRows(const BusPlan& plan, const std::vector<LoggedSignal>& signals);

  /// Takes the next frame. `us` is its time. Returns the row that this frame ends. The row is valid
  /// until the next call.
  std::optional<LogRow> take(const Frame& frame, std::int64_t us);
  /// Returns the last row.
  std::optional<LogRow> finish();

 private:
  struct Field {
    PdoField place;
    std::size_t column = 0;
  };
  /// The values that come between two SYNCs.
  struct Values {
    std::vector<std::int64_t> raw;
    std::vector<std::uint8_t> fresh;
  };

  bool begins_cycle(const Frame& frame, std::int64_t us) const;
  std::optional<LogRow> end_cycle();
  void keep(const Frame& frame);

  CobId sync_;
  bool has_sync_;
  std::int64_t period_us_;
  std::map<CobId, std::vector<Field>> fields_;
  Values coming_;
  Values ended_;
  std::int64_t begin_us_ = 0;  // begin of the cycle
  std::int64_t cycle_ = -1;    // -1: before the first SYNC
  std::int64_t lost_ = 0;
};

}  // namespace takt::logging
