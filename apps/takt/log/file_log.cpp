#include "apps/takt/log/file_log.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <iostream>
#include <iterator>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>

#include "apps/command_line/failure.hpp"
#include "apps/command_line/finding_text.hpp"
#include "apps/command_line/text_file.hpp"
#include "apps/takt/log/frame_rows.hpp"
#include "apps/takt/log/log_output.hpp"
#include "eds_parser/network_file/load_network.hpp"
#include "master/black_box/recorded_network.hpp"
#include "master/explain/frame/error_frame_text.hpp"
#include "master/explain/frame/frame_text.hpp"
#include "master/gateway/message/image_messages.hpp"
#include "master/trace/recorded_lines.hpp"
#include "master/trace/time_stamp.hpp"
#include "master/trace/trace_line.hpp"

namespace takt::logging {
namespace {

std::string hex_bytes(std::span<const std::uint8_t> bytes) {
  std::string text;
  for (const std::uint8_t byte : bytes) {
    text += fmt::format("{}{:02X}", text.empty() ? "" : " ", byte);
  }
  return text;
}

/// Returns the events of a recording of the black box in the order of time, or an empty list if the
/// file is no such recording. The files may have any content.
std::vector<LogEvent> events_of(const std::string& log) {
  std::vector<LogEvent> events;
  const auto text = read_whole_file(events_file_of(log));
  if (!text) return events;
  const auto document = nlohmann::json::parse(*text, nullptr, false);
  if (!document.is_object() || !document.contains("events")) return events;
  for (const nlohmann::json& event : document["events"]) {
    try {
      events.push_back({.utime = event.value("utime", std::int64_t{0}),
                        .cycle = event.value("cycle", std::int64_t{0}),
                        .kind = event.value("kind", ""),
                        .text = event.value("text", "")});
    } catch (const nlohmann::json::exception&) {
      continue;
    }
  }
  std::ranges::stable_sort(events, {}, &LogEvent::utime);
  return events;
}

std::vector<signal_t> layout_of(const BusPlan& plan) {
  std::vector<signal_t> signals;
  for (layout_t& message : layout_messages(plan, 0)) {
    std::ranges::move(message.signals, std::back_inserter(signals));
  }
  return signals;
}

class FileLog {
 public:
  explicit FileLog(const FileLogOptions& options)
      : options_{options}, log_{log_of_recording(options.file)} {
    const std::string network =
        options.network.empty() ? network_of_recording(log_) : options.network;
    if (!network.empty()) load(network);
    if (!network_ && (format_of(options.output) == LogFormat::csv || !options.patterns.empty())) {
      throw Failure{log_ +
                        ": the signals need a network file: --network NET.yaml. Without one, an "
                        ".mcap file has the frames only",
                    exit_wrong_use};
    }
    meaning_ = network_ ? std::make_unique<FrameText>(network_->plan, network_->devices)
                        : std::make_unique<FrameText>();
  }

  void run() {
    if (options_.file == "-") return run(std::cin, "stdin");
    std::ifstream file{log_, std::ios::binary};
    std::error_code none;
    if (!file || std::filesystem::is_directory(log_, none)) {
      throw Failure{log_ + ": can't be read: " + std::strerror(file ? EISDIR : errno),
                    exit_wrong_use};
    }
    events_ = events_of(log_);
    run(file, log_);
  }

 private:
  void load(const std::string& network) {
    network_ = load_network(network);
    if (print_findings(network_->findings, Severity::error)) {
      throw Failure{network + ": the network file has errors", exit_wrong_use};
    }
    head_.bus = network_->plan.name;
    head_.period = network_->plan.cycle.period;
    head_.signals =
        value_or_fail(choose_signals(layout_of(network_->plan), options_.patterns), exit_wrong_use);
    rows_.emplace(network_->plan, head_.signals);
  }

  void run(std::istream& in, const std::string& name) {
    std::string text;
    RecordedLines lines;
    std::uint64_t number = 0;
    while (reason_.empty() && std::getline(in, text)) {
      ++number;
      if (const auto line = lines.parse(text)) {
        take(*line, fmt::format("{}:{}", name, number));
      } else if (!is_remark(text)) {
        ++strange_;
      }
    }
    if (!output_) {
      throw Failure{
          name + ": holds no frame; `candump -L can0 > FILE` makes a recording that takt reads",
          exit_wrong_use};
    }
    if (rows_ && reason_.empty()) {
      if (const auto row = rows_->finish()) add(*row);
    }
    add_events_until(std::numeric_limits<std::int64_t>::max());
    if (strange_ != 0) fmt::print(stderr, "{}: {} lines hold no frame\n", name, strange_);
    output_->finish(reason_.empty() ? "all of " + name : reason_);
  }

  void take(const CandumpLine& line, const std::string& where) {
    const auto us = stamp_in_us(line.stamp);
    if (!us) throw Failure{where + ": has no time stamp; record with `candump -L`", exit_wrong_use};
    if (!output_) {
      interface_ = options_.interface.empty() ? line.interface : options_.interface;
      if (head_.bus.empty()) head_.bus = line.interface.empty() ? "bus" : line.interface;
    }
    if (line.interface != interface_) return;
    if (!output_) output_.emplace(options_.output, head_, true);
    if (rows_ && !line.error_frame) {
      if (const auto row = rows_->take(line.frame, *us)) add(*row);
    }
    add_events_until(*us);
    if (!output_->takes_frames()) return;
    const FrameMeaning meaning =
        line.error_frame
            ? FrameMeaning{.service = "ERROR",
                           .text = error_frame_text(line.frame.id.id(), line.frame.payload())}
            : meaning_->meaning(line.frame);
    keep(output_->frame({.utime = *us,
                         .id = to_string(line.frame.id),
                         .data = line.frame.rtr ? "" : hex_bytes(line.frame.payload()),
                         .service = std::string{meaning.service},
                         .node = meaning.node,
                         .text = meaning.text}));
  }

  void add(const LogRow& row) {
    add_events_until(row.utime);
    keep(output_->row(row));
  }

  void add_events_until(std::int64_t utime) {
    for (; next_event_ < events_.size() && events_[next_event_].utime <= utime; ++next_event_) {
      keep(output_->event(events_[next_event_]));
    }
  }

  void keep(bool written) {
    if (!written) reason_ = "the file is full";
  }

  const FileLogOptions& options_;
  std::string log_;
  std::optional<LoadedNetwork> network_;
  LogHead head_;
  std::unique_ptr<FrameText> meaning_;
  std::optional<FrameRows> rows_;
  std::optional<LogOutput> output_;
  std::vector<LogEvent> events_;
  std::size_t next_event_ = 0;
  std::string interface_;
  std::uint64_t strange_ = 0;
  std::string reason_;
};

}  // namespace

void log_file(const FileLogOptions& options) {
  format_of(options.output);
  FileLog{options}.run();
}

}  // namespace takt::logging
