#include "apps/takt/live/view/bus_lines.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <sstream>

#include "apps/takt/live/text/node_words.hpp"
#include "master/rt/exchange/status_board.hpp"

namespace takt {
namespace {

constexpr std::size_t bar_columns = 20;

Paint load_paint(double load) {
  if (load > 0.9) return Paint::bad;
  return load > 0.7 ? Paint::warning : Paint::good;
}

/// Returns for example "late 4", in the colour of a warning unless the count is 0.
PaintedText counter(std::string_view what, std::int64_t count) {
  return {fmt::format("{} {}", what, count), count == 0 ? Paint::dim : Paint::warning};
}

PaintedText alarm(bool set, const char* text) { return {set ? text : "", Paint::bad}; }

PaintedText bus_state(const status_t& status) {
  static constexpr const char* states[] = {"error active", "error passive", "BUS OFF",
                                           "INTERFACE DOWN"};
  const auto state = static_cast<std::size_t>(std::clamp<int>(status.bus_state, 0, 3));
  return {states[state], state == 0 ? Paint::good : Paint::bad};
}

/// Returns the line about the SYNC of a foreign producer.
std::vector<PaintedText> sync_items(const sync_status_t& sync) {
  const bool locked = sync.state == static_cast<int>(SyncState::locked);
  const bool lost = sync.state == static_cast<int>(SyncState::lost);
  return {{"SYNC " + sync.text, locked ? Paint::good
                                : lost ? Paint::bad
                                       : Paint::warning},
          counter("SYNC lost", sync.losses)};
}

}  // namespace

std::vector<Line> bus_lines(const BusView& bus, std::size_t width) {
  const status_t& status = *bus.status();
  const diagnosis_t& diagnosis = status.diagnosis;
  std::vector<Line> lines =
      flow({{status.bus, Paint::title},
            {fmt::format("on {}", status.interface)},
            {fmt::format("{} kbit/s", status.bitrate / 1000)},
            bus_state(status),
            {fmt::format("{:.3f} ms", static_cast<double>(status.period_ns) / 1e6)},
            {fmt::format("cycle {}", status.cycle)},
            counter("missed", status.cycles_missed),
            counter("late", status.cycles_late)},
           width);
  const double load = status.bus_load;
  append(lines, flow({{"load " + bar(load, std::min(bar_columns, width / 4)), load_paint(load)},
                      {fmt::format("{:.0f} %", 100.0 * load)},
                      {"bus " + bus_condition(diagnosis.state),
                       diagnosis.state == 0 ? Paint::good : Paint::bad},
                      {fmt::format("nodes not ok {}", diagnosis.nodes_not_ok),
                       diagnosis.nodes_not_ok == 0 ? Paint::dim : Paint::bad},
                      alarm(diagnosis.warning_limit != 0, "WARNING LIMIT"),
                      alarm(diagnosis.rx_queue_exceeded != 0, "RECEIVE QUEUE EXCEEDED"),
                      alarm(diagnosis.tx_queue_exceeded != 0, "SEND QUEUE EXCEEDED"),
                      alarm(diagnosis.send_error != 0, "SEND ERROR"),
                      alarm(bus.two_daemons(), "TWO DAEMONS RUN A BUS OF THIS NAME")},
                     width));
  if (bus.sync() && bus.sync()->timeout_ns != 0)
    append(lines, flow(sync_items(*bus.sync()), width));
  append(lines, stop_lines(status, width));
  return lines;
}

std::vector<Line> counter_lines(const BusView& bus, std::size_t width) {
  const status_t& status = *bus.status();
  std::vector<Line> lines =
      flow({{fmt::format("{} in", status.frames_received), Paint::dim},
            {fmt::format("{} out", status.frames_sent), Paint::dim},
            counter("not sent", status.send_failures),
            counter("lost", status.receive_overruns),
            counter("error frames", status.error_frames),
            {fmt::format("SYNCs {}", status.diagnosis.sync_count), Paint::dim},
            counter("no outputs", status.diagnosis.outputs_skipped),
            counter("incomplete", status.diagnosis.images_incomplete)},
           width);
  append(lines, paragraph("real time: " + status.realtime, Paint::dim, width, 2));
  return lines;
}

std::vector<Line> stop_lines(const status_t& status, std::size_t width) {
  if (status.stop == 0) return {};
  const bool bad = status.stop == static_cast<int>(StopResult::unconfirmed);
  std::vector<Line> lines = paragraph("ordered stop " + stop_name(status.stop),
                                      bad ? Paint::bad : Paint::plain, width, 2);
  std::istringstream axes{status.stop_text};
  for (std::string axis; std::getline(axes, axis);) {
    append(lines, paragraph("- " + axis, Paint::bad, width, 2));
  }
  return lines;
}

}  // namespace takt
