#pragma once
#include <deque>
#include <optional>
#include <string>

#include "apps/mcap/byte_sink.hpp"
#include "apps/takt/log/log_writer.hpp"

namespace takt::logging {

/// Writes one line a cycle: `time [s]` since the first line, `utime [us]` since 1970, `cycle`, one
/// column a signal, and `event`. A cell is empty if its signal has no new value in this cycle. An
/// event is written in the first line after it. The format is that of RFC 4180, with line feeds.
class CsvLog final : public LogWriter {
 public:
  /// `sink` must live longer than the log.
  CsvLog(mcap::ByteSink& sink, const LogHead& head);

  bool row(const LogRow& row) override;
  bool event(const LogEvent& event) override;
  bool finish() override;

 private:
  bool flush();
  void append_events();

  mcap::ByteSink& sink_;
  std::vector<LoggedSignal> signals_;
  std::string lines_;               // lines that are not yet written
  std::deque<std::string> events_;  // events for the next line
  std::size_t events_left_out_ = 0;
  std::optional<std::int64_t> first_ns_;
  std::int64_t written_ns_ = 0;
  LogRow last_;
  bool good_ = true;
};

}  // namespace takt::logging
