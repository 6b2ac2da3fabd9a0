#include "apps/takt/log/mcap_log.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "apps/takt/log/log_schemas.hpp"
#include "master/lcm/printable_text.hpp"

namespace takt::logging {
namespace {

/// Returns the text as a JSON string. Bytes that are not UTF-8 become U+FFFD.
std::string json_string(const std::string& text) {
  return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::uint64_t ns_of(std::int64_t utime) {
  return static_cast<std::uint64_t>(std::max<std::int64_t>(utime, 0)) * 1000;
}

mcap::Channel channel(const LogHead& head, const std::string& what, const std::string& schema,
                      const nlohmann::json& json) {
  return {.topic = "/" + head.bus + "/" + what,
          .message_encoding = "json",
          .schema_name = schema,
          .schema_encoding = "jsonschema",
          .schema = json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace),
          .notes = {{"bus", head.bus}, {"period_ns", std::to_string(head.period.count())}}};
}

}  // namespace

McapLog::McapLog(mcap::ByteSink& sink, const LogHead& head, FrameChannelUse frames)
    : begin_{"{" + json_string(cycle_field(head.signals)) + ":"}, writer_{sink, "takt"} {
  for (std::size_t at = 0; at < head.signals.size(); ++at) {
    const LoggedSignal& signal = head.signals[at];
    columns_.push_back({at, signal.format, signal.node, json_string(signal.name) + ":"});
  }
  std::ranges::stable_sort(columns_, {}, &Column::node);
  std::string last;
  for (Column& column : columns_) {
    const bool is_same = &column != columns_.data() && column.node == last;
    last = column.node;
    column.node = is_same ? "" : json_string(column.node) + ":{";
  }
  if (!columns_.empty()) {
    images_ = writer_.add(channel(head, "image", "takt.image", image_schema(head.signals)));
  }
  events_ = writer_.add(channel(head, "event", "foxglove.Log", event_schema()));
  if (frames == FrameChannelUse::one) {
    frames_ = writer_.add(channel(head, "frame", "takt.frame", frame_schema()));
  }
}

bool McapLog::row(const LogRow& row) {
  if (row.lost > 0 && !event(gap_event(row))) return false;
  json_ = begin_ + std::to_string(row.cycle);
  bool is_first = true;  // the next value is the first of its node
  for (const Column& column : columns_) {
    if (!column.node.empty()) {
      json_ += (&column == columns_.data() ? "," : "},") + column.node;
      is_first = true;
    }
    if (row.fresh[column.at] == 0) continue;
    const std::size_t before = json_.size();
    if (!is_first) json_ += ',';
    json_ += column.name;
    if (append_value(json_, column.format, row.raw[column.at])) {
      is_first = false;
    } else {
      json_.resize(before);  // JSON has no word for NaN
    }
  }
  json_ += columns_.empty() ? "}" : "}}";
  return writer_.write(images_, ns_of(row.utime), json_);
}

bool McapLog::event(const LogEvent& event) {
  static constexpr int levels[]{2, 3, 4};  // INFO, WARNING, ERROR
  const std::string json = fmt::format(
      R"({{"timestamp":{{"sec":{},"nsec":{}}},"level":{},"message":{},"name":{},"file":{},"line":{}}})",
      event.utime / 1'000'000, event.utime % 1'000'000 * 1000,
      levels[std::clamp(event.severity, 0, 2)], json_string(printable_lines(event.text)),
      json_string(event.node), json_string(event.kind), event.cycle);
  return writer_.write(events_, ns_of(event.utime), json);
}

bool McapLog::frame(const LogFrame& frame) {
  if (frames_ == 0) return true;
  const std::string json = fmt::format(
      R"({{"id":{},"data":{},"service":{},"node":{},"text":{}}})", json_string(frame.id),
      json_string(frame.data), json_string(frame.service), frame.node, json_string(frame.text));
  return writer_.write(frames_, ns_of(frame.utime), json);
}

}  // namespace takt::logging
