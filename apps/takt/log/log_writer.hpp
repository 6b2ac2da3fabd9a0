#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "apps/takt/log/logged_signal.hpp"
#include "eds_parser/table/time.hpp"

namespace takt::logging {

/// What a log is about.
struct LogHead {
  std::string bus{};
  Time period{};  ///< of SYNC
  std::vector<LoggedSignal> signals{};
};

/// The values of one cycle.
struct LogRow {
  std::int64_t utime = 0;    ///< wall clock of SYNC, microseconds since 1970
  std::int64_t sync_ns = 0;  ///< of SYNC, on a clock that is never corrected
  std::int64_t cycle = 0;
  std::int64_t lost = 0;                  ///< cycles between the row before and this one
  std::span<const std::int64_t> raw{};    ///< in the order of LogHead::signals
  std::span<const std::uint8_t> fresh{};  ///< 0: this signal has no new value in this cycle
};

struct LogEvent {
  std::int64_t utime = 0;
  std::int64_t cycle = 0;
  int severity = 0;  ///< 0 note, 1 warning, 2 error
  std::string node{};
  std::string kind{};
  std::string text{};
};

/// One frame of the bus, and its meaning.
struct LogFrame {
  std::int64_t utime = 0;
  std::string id{};       ///< "0x181"
  std::string data{};     ///< hex, with blanks
  std::string service{};  ///< "TPDO"
  unsigned node = 0;      ///< 0: none or all
  std::string text{};
};

/// Writes a log in one of the formats. All calls return false when the file takes no more: what was
/// written before stays.
class LogWriter {
 public:
  virtual ~LogWriter() = default;
  virtual bool row(const LogRow& row) = 0;
  virtual bool event(const LogEvent& event) = 0;
  /// Most formats have no place for frames.
  virtual bool frame(const LogFrame& frame) {
    static_cast<void>(frame);
    return true;
  }
  /// Returns false if the file is not complete.
  virtual bool finish() = 0;
};

/// Returns the event that tells of the cycles that are missing before a row.
inline LogEvent gap_event(const LogRow& row) {
  return {.utime = row.utime,
          .cycle = row.cycle,
          .severity = 1,
          .kind = "gap",
          .text = std::to_string(row.lost) + (row.lost == 1 ? " cycle is" : " cycles are") +
                  " missing before cycle " + std::to_string(row.cycle)};
}

}  // namespace takt::logging
