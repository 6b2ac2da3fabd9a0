#include "apps/takt/live/view/top_frame.hpp"

#include <algorithm>
#include <chrono>
#include <ctime>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <utility>

#include "apps/takt/live/view/axis_view.hpp"
#include "apps/takt/live/view/bus_lines.hpp"
#include "master/gateway/notice/merged_notices.hpp"

namespace takt {
namespace {

/// Returns the number of lines of the terminal that are reserved for messages.
std::size_t message_lines(std::size_t rows) {
  return rows == 0 ? 6 : std::clamp<std::size_t>(rows / 5, 2, 6);
}

/// Returns the names of all pages with their keys.
std::vector<Line> tabs(const TopOptions& options) {
  std::vector<PaintedText> items;
  for (std::size_t i = 0; i < page_names.size(); ++i) {
    const bool shown = i == static_cast<std::size_t>(options.page);
    const std::string name = fmt::format("{} {}", i + 1, page_names[i]);
    items.push_back({shown ? "[" + name + "]" : name, shown ? Paint::title : Paint::dim});
  }
  return flow(items, options.columns);
}

/// Returns the newest `most` events, the oldest first. Events of one cause share a line.
std::vector<event_t> newest_events(const BusView& bus, std::int64_t since, std::size_t most) {
  constexpr std::int64_t same_cause_us = same_cause / std::chrono::microseconds{1};
  std::vector<event_t> events;
  for (const event_t& event : bus.events()) {
    if (event.utime <= since) continue;
    if (!events.empty() && events.back().kind == event.kind &&
        event.utime - events.back().utime <= same_cause_us) {
      if (auto text = merged_text(events.back().text, event.text)) {
        events.back().text = *std::move(text);
        continue;
      }
    }
    events.push_back(event);
  }
  if (events.size() > most) {
    events.erase(events.begin(), events.end() - static_cast<std::ptrdiff_t>(most));
  }
  return events;
}

Line event_line(const event_t& event, std::size_t width) {
  static constexpr Paint paints[] = {Paint::plain, Paint::warning, Paint::bad};
  const std::time_t seconds = event.utime / 1'000'000;
  const std::string_view text{event.text};
  const std::string first{text.substr(0, text.find('\n'))};
  constexpr std::size_t clock_columns = 9;
  const std::size_t room = width > clock_columns ? width - clock_columns : 1;
  return Line{}
      .add(fmt::format("{:%H:%M:%S} ", fmt::localtime(seconds)), Paint::dim)
      .add(shortened(first, room), paints[std::clamp<int>(event.severity, 0, 2)]);
}

/// Adds the rows of the page that fit into `room` lines, from `wanted` on, and a line that says
/// which rows are shown. Returns the first row that is shown.
std::size_t add_rows(std::vector<Line>& lines, const std::vector<Line>& rows, std::size_t wanted,
                     std::size_t room) {
  const std::size_t shown = std::min(room, rows.size());
  const std::size_t first = std::min(wanted, rows.size() - shown);
  for (std::size_t i = first; i < first + shown; ++i) lines.push_back(rows[i]);
  Line which;
  if (shown < rows.size()) {
    which.add(fmt::format("[{}-{} of {}, arrows scroll]", first + 1, first + shown, rows.size()),
              Paint::dim);
  }
  lines.push_back(std::move(which));
  return first;
}

}  // namespace

std::vector<Line> status_lines(const BusView& bus, std::size_t width) {
  std::vector<Line> lines = bus_lines(bus, width);
  append(lines, counter_lines(bus, width));
  append(lines, nodes_page(bus, width).all());
  if (!axes_of(bus).empty()) append(lines, words_page(bus, width).all());
  return lines;
}

TopFrame top_frame(const BusView& bus, const TopOptions& options) {
  if (!bus.status()) return {};
  const bool limited = options.rows != 0;
  TopFrame frame{.lines = bus_lines(bus, options.columns)};
  std::vector<Line>& lines = frame.lines;
  if (limited) append(lines, tabs(options));
  const Table::Text page = page_text(options.page, bus, options.columns);
  append(lines, page.head);
  std::vector<Line> rows = page.body;
  if (options.page == Page::axes && !axes_of(bus).empty()) {
    append(rows, words_page(bus, options.columns).all());
  }
  const std::size_t messages = message_lines(options.rows);
  const std::size_t used = lines.size() + 1 + messages;
  const std::size_t room =
      limited ? std::max<std::size_t>(options.rows, used + 3) - used : rows.size();
  frame.first_row = add_rows(lines, rows, options.first_row, room);
  for (const event_t& event : newest_events(bus, options.seen_until, messages)) {
    lines.push_back(event_line(event, options.columns));
  }
  return frame;
}

}  // namespace takt
