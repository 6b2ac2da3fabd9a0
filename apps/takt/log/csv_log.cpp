#include "apps/takt/log/csv_log.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <iterator>

#include "master/lcm/printable_text.hpp"

namespace takt::logging {
namespace {

constexpr std::size_t block_bytes = 65'536;
// Longest time for which a line waits before it is written to the file.
constexpr std::int64_t longest_wait_ns = 200'000'000;
constexpr std::size_t most_events = 100;  // largest number of events that wait for a line

void append_cell(std::string& out, std::string_view text) {
  if (text.find_first_of(",\"\n\r") == text.npos) {
    out += text;
    return;
  }
  out += '"';
  for (const char letter : text) {
    if (letter == '"') out += '"';
    out += letter;
  }
  out += '"';
}

std::string_view severity_name(int severity) {
  return severity <= 0 ? "note" : severity == 1 ? "warning" : "error";
}

}  // namespace

CsvLog::CsvLog(mcap::ByteSink& sink, const LogHead& head) : sink_{sink}, signals_{head.signals} {
  lines_ = "time [s],utime [us],cycle";
  for (const LoggedSignal& signal : signals_) {
    const std::string unit = signal.unit.empty() ? "" : " [" + signal.unit + "]";
    lines_ += ',';
    append_cell(lines_, printable_text(signal.full_name() + unit));
  }
  lines_ += ",event\n";
  flush();
}

bool CsvLog::event(const LogEvent& event) {
  if (events_.size() == most_events) {
    ++events_left_out_;
    return good_;
  }
  const std::string node = event.node.empty() ? "" : event.node + ": ";
  events_.push_back(printable_text(fmt::format("cycle {}: {}: {}{}", event.cycle,
                                               severity_name(event.severity), node, event.text)));
  return good_;
}

void CsvLog::append_events() {
  lines_ += ',';
  std::string cell;
  for (const std::string& text : events_) cell += (cell.empty() ? "" : " | ") + text;
  if (events_left_out_ != 0) cell += fmt::format(" | and {} more", events_left_out_);
  append_cell(lines_, cell);
  lines_ += '\n';
  events_.clear();
  events_left_out_ = 0;
}

bool CsvLog::row(const LogRow& row) {
  if (!good_) return false;
  if (row.lost > 0) event(gap_event(row));
  if (!first_ns_) written_ns_ = *(first_ns_ = row.sync_ns);
  const std::int64_t ns = row.sync_ns - *first_ns_;
  last_ = row;
  fmt::format_to(std::back_inserter(lines_), "{}{}.{:09},{},{}", ns < 0 ? "-" : "",
                 std::abs(ns) / 1'000'000'000, std::abs(ns) % 1'000'000'000, row.utime, row.cycle);
  for (std::size_t i = 0; i < signals_.size(); ++i) {
    lines_ += ',';
    if (row.fresh[i] != 0) append_value(lines_, signals_[i].format, row.raw[i]);
  }
  append_events();
  const bool is_due = row.sync_ns - written_ns_ >= longest_wait_ns;
  if (lines_.size() < block_bytes && !is_due) return true;
  written_ns_ = row.sync_ns;
  return flush();
}

bool CsvLog::flush() {
  good_ = good_ && sink_.write(lines_);
  lines_.clear();
  return good_;
}

bool CsvLog::finish() {
  if (!events_.empty()) {
    // These events came after the last cycle, so their line has no values.
    const std::vector<std::int64_t> raw(signals_.size());
    const std::vector<std::uint8_t> fresh(signals_.size());
    LogRow rest = last_;
    rest.lost = 0;
    rest.raw = raw;
    rest.fresh = fresh;
    row(rest);
  }
  return flush();
}

}  // namespace takt::logging
