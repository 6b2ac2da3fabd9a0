#pragma once
#include <cstdint>
#include <optional>
#include <span>

#include "eds_parser/table/bus_plan.hpp"
#include "master/core/pdo_status.hpp"

namespace takt {

/// The values that the ordered stop gets from TPDOs in one cycle.
struct ReceivedValues {
  std::span<const std::int64_t> values{};  ///< values of the image
  std::span<const std::uint64_t> stale{};  ///< stale signals of the image, one bit for each
  std::span<const PdoMark> marks{};        ///< counters of the TPDOs, by row
};

/// The TPDO that carries one value of an axis. The image repeats the newest value in each cycle, so
/// a value counts only if a new frame has come. Bus thread only.
class AxisSource {
 public:
  /// If a TPDO is silent for longer than this time, the value is also read by SDO.
  static constexpr Time longest_silence = std::chrono::milliseconds{50};

  /// `signal` is empty if no TPDO carries the value.
  AxisSource(const BusPlan& plan, std::optional<SignalIndex> signal);

  /// Begins a stop. Frames that came before the next call of take() do not count.
  void begin() noexcept { begun_ = false; }
  /// Returns the value if a frame has come since the previous call.
  std::optional<std::int64_t> take(Time now, const ReceivedValues& received) noexcept;
  /// Returns the newest value, even if it came before the stop. Returns std::nullopt if it may be
  /// out of date.
  std::optional<std::int64_t> newest(const ReceivedValues& received) const noexcept;
  /// Returns true if a TPDO carries the value often enough for the ordered stop.
  bool serves(Time now) const noexcept {
    return signal_ && !slow_ && !stale_ && now - newest_ < longest_silence;
  }
  bool mapped() const noexcept { return signal_.has_value(); }

 private:
  std::optional<SignalIndex> signal_;
  std::uint16_t row_ = PdoTable::no_row;
  /// True if the period, the inhibit time or the event timer of the TPDO is longer than
  /// `longest_silence`.
  bool slow_ = false;
  bool stale_ = false;
  bool begun_ = false;        ///< take() was called since begin().
  std::uint32_t frames_ = 0;  ///< frames of the TPDO at the previous call of take()
  Time newest_{};             ///< time of the newest frame, or of the first take()
};

}  // namespace takt
