#include "apps/takt/log/log_output.hpp"

#include <cstdio>
#include <fmt/format.h>

#include "apps/command_line/failure.hpp"
#include "apps/takt/log/csv_log.hpp"
#include "apps/takt/log/mcap_log.hpp"
#include "master/lcm/printable_text.hpp"

namespace takt::logging {
namespace {

constexpr std::size_t most_named_gaps = 5;

const char* plural(std::uint64_t count) { return count == 1 ? "" : "s"; }

}  // namespace

LogFormat format_of(const std::string& path) {
  if (path == "-" || path.ends_with(".csv")) return LogFormat::csv;
  if (path.ends_with(".mcap")) return LogFormat::mcap;
  throw Failure{path + ": the name has to end in .csv or .mcap; `-o -` writes CSV to stdout",
                exit_wrong_use};
}

LogOutput::LogOutput(const std::string& path, const LogHead& head, bool with_frames)
    : path_{path},
      file_{value_or_fail(LogFile::create(path), exit_wrong_use)},
      takes_frames_{with_frames && format_of(path) == LogFormat::mcap},
      signals_{head.signals.size()} {
  if (format_of(path) == LogFormat::csv) {
    writer_ = std::make_unique<CsvLog>(*file_, head);
  } else {
    writer_ = std::make_unique<McapLog>(
        *file_, head, takes_frames_ ? FrameChannelUse::one : FrameChannelUse::none);
  }
}

bool LogOutput::row(const LogRow& row) {
  if (rows_ == 0) first_ns_ = row.sync_ns;
  if (!writer_->row(row)) return false;
  last_ns_ = row.sync_ns;
  ++rows_;
  if (row.lost <= 0) return true;
  ++gap_count_;
  lost_ += row.lost;
  if (gaps_.size() < most_named_gaps) gaps_.push_back({row.cycle, row.lost});
  return true;
}

bool LogOutput::event(const LogEvent& event) {
  if (!writer_->event(event)) return false;
  ++events_;
  return true;
}

bool LogOutput::frame(const LogFrame& frame) {
  if (!writer_->frame(frame)) return false;
  ++frames_;
  return true;
}

std::string LogOutput::gaps_text() const {
  if (gap_count_ == 0) return "no gap";
  std::string text = fmt::format("{} {} missing in {} gap{} (", lost_,
                                 lost_ == 1 ? "cycle" : "cycles", gap_count_, plural(gap_count_));
  for (const Gap& gap : gaps_) {
    text +=
        fmt::format("{}{} before cycle {}", &gap == gaps_.data() ? "" : ", ", gap.lost, gap.cycle);
  }
  return text + (gap_count_ > gaps_.size() ? ", ...)" : ")");
}

void LogOutput::finish(const std::string& reason) {
  const bool complete = writer_->finish();
  const std::string trouble = file_->trouble();
  const bool is_csv = format_of(path_) == LogFormat::csv;
  if ((!complete && !is_csv) || file_->size() == 0) {
    throw Failure{path_ + ": can't be written: " + (trouble.empty() ? "no room" : trouble) +
                      "; no file is left",
                  1};
  }
  value_or_fail(file_->commit(), 1);
  if (complete && trouble.empty()) {
    const std::string frames = frames_ == 0 ? "" : fmt::format(", {} frames", frames_);
    fmt::print(stderr, "takt: {}: {} cycles in {:.3f} s, {} signal{}, {} event{}{}, {}; {}\n",
               path_ == "-" ? "stdout" : printable_text(path_), rows_,
               static_cast<double>(last_ns_ - first_ns_) * 1e-9, signals_, plural(signals_),
               events_, plural(events_), frames, gaps_text(), reason);
    return;
  }
  throw Failure{path_ + ": the log ends here: " + (trouble.empty() ? "the file is full" : trouble) +
                    ". What came before is in the file",
                1};
}

}  // namespace takt::logging
