#pragma once
#include <cstdint>
#include <memory>
#include <string>

#include "apps/taktd/process/line_writer.hpp"
#include "master/gateway/notice/notice.hpp"

namespace spdlog {
class logger;
}

namespace takt {

/// Writes sentences for the user to stderr, with the time of day. If stderr leads to the journal of
/// systemd (JOURNAL_STREAM), each line has its priority instead, as in "<4>", because the journal
/// has the time: sd-daemon(3). No caller waits if stderr accepts no data. The log counts the lines
/// that are lost and reports their number with the next line.
class ErrorLog {
 public:
  /// Writes to `file` instead of stderr.
  explicit ErrorLog(FileDescriptor file = stderr_again(),
                    LineWriter::StartThread start = LineWriter::start_detached);
  ~ErrorLog();
  ErrorLog(const ErrorLog&) = delete;
  ErrorLog& operator=(const ErrorLog&) = delete;

  void say(Weight weight, const std::string& sentence);
  /// Returns false if stderr has not accepted everything within `limit`.
  bool flush(Time limit) { return writer_.flush(limit); }

 private:
  enum class Form : std::uint8_t { plain, coloured, journal };

  class Sink;
  ErrorLog(Form form, FileDescriptor file, LineWriter::StartThread start);
  static Form form_of(int file);
  static FileDescriptor stderr_again();

  LineWriter writer_;
  std::unique_ptr<spdlog::logger> log_;
  bool without_thread_reported_ = false;
};

}  // namespace takt
