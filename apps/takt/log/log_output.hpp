#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "apps/takt/log/log_file.hpp"
#include "apps/takt/log/log_writer.hpp"

namespace takt::logging {

/// The format of a log, which the ending of the file name selects.
enum class LogFormat : std::uint8_t { csv, mcap };

/// Returns the format of a file: `.csv`, `.mcap`, or `-` for CSV on stdout. Throws a Failure for
/// any other name.
LogFormat format_of(const std::string& path);

/// One log: its file, its format, and the counts for the summary line.
class LogOutput {
 public:
  /// `with_frames` requests that frames are recorded, which only MCAP files can contain. Throws a
  /// Failure if the file can't be made.
  LogOutput(const std::string& path, const LogHead& head, bool with_frames);

  bool takes_frames() const noexcept { return takes_frames_; }

  /// These functions return false when nothing more can be written to the file.
  bool row(const LogRow& row);
  bool event(const LogEvent& event);
  bool frame(const LogFrame& frame);

  /// Completes the file and prints the summary line on stderr, with the reason why the log ended.
  /// Throws a Failure with exit code 1 if the disk was full: what was written before is in the
  /// file, or there is no file.
  void finish(const std::string& reason);

 private:
  /// A gap in the log. The summary names the first gaps.
  struct Gap {
    std::int64_t cycle = 0;
    std::int64_t lost = 0;
  };

  std::string gaps_text() const;

  std::string path_;
  std::unique_ptr<LogFile> file_;
  std::unique_ptr<LogWriter> writer_;
  bool takes_frames_;
  std::size_t signals_;
  std::uint64_t rows_ = 0;
  std::uint64_t events_ = 0;
  std::uint64_t frames_ = 0;
  std::uint64_t gap_count_ = 0;
  std::int64_t lost_ = 0;
  std::vector<Gap> gaps_;
  std::int64_t first_ns_ = 0;
  std::int64_t last_ns_ = 0;
};

}  // namespace takt::logging
