#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "apps/takt/log/logged_signal.hpp"
#include "eds_parser/values/time.hpp"

namespace takt::logging {

/// The bus and the signals that a log records.
struct LogHead {
  std::string bus{};
  Time period{};  ///< period of SYNC
  std::vector<LoggedSignal> signals{};
};

/// The values of one cycle.
struct LogRow {
  std::int64_t utime = 0;    ///< wall clock of SYNC, microseconds since 1970
  std::int64_t sync_ns = 0;  ///< time of SYNC on a clock that is never corrected
  std::int64_t cycle = 0;
  std::int64_t lost = 0;  ///< number of cycles that are missing between the row before and this one
  std::span<const std::int64_t> raw{};    ///< raw values in the order of LogHead::signals
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
  std::string id{};       ///< COB-ID, for example "0x181"
  std::string data{};     ///< data bytes in hex, separated by blanks
  std::string service{};  ///< service, for example "TPDO"
  unsigned node = 0;      ///< node-ID; 0 if the frame belongs to no node or to all nodes
  std::string text{};
};

/// Writes a log in one of the formats. All calls return false when nothing more can be written to
/// the file. What was written before remains in the file.
class LogWriter {
 public:
  virtual ~LogWriter() = default;
  virtual bool row(const LogRow& row) = 0;
  virtual bool event(const LogEvent& event) = 0;
  /// Writes a frame. A format that can't contain frames leaves it out.
  virtual bool frame(const LogFrame& frame) {
    static_cast<void>(frame);
    return true;
  }
  /// Returns false if the file is not complete.
  virtual bool finish() = 0;
};

/// Returns the event that reports the cycles that are missing before a row.
inline LogEvent gap_event(const LogRow& row) {
  return {.utime = row.utime,
          .cycle = row.cycle,
          .severity = 1,
          .kind = "gap",
          .text = std::to_string(row.lost) + (row.lost == 1 ? " cycle is" : " cycles are") +
                  " missing before cycle " + std::to_string(row.cycle)};
}

}  // namespace takt::logging
