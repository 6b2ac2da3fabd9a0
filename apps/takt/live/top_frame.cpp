#include "apps/takt/live/top_frame.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <ctime>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sstream>
#include <utility>

#include "apps/takt/live/timing_table.hpp"
#include "master/core/node_status.hpp"
#include "master/explain/boot_report.hpp"
#include "master/rt/exchange/status_board.hpp"

namespace takt {
namespace {

/// Returns how many lines of the terminal are reserved for messages.
std::size_t message_lines(std::size_t rows) {
  return rows == 0 ? 6 : std::clamp<std::size_t>(rows / 5, 2, 6);
}

Paint nmt_paint(int state) {
  if (state == static_cast<int>(NmtState::operational)) return Paint::good;
  return state == static_cast<int>(NmtState::unknown) ? Paint::dim : Paint::warning;
}

Paint boot_paint(int state) {
  using enum BootState;
  const auto boot = static_cast<BootState>(state);
  if (boot == failed || boot == lost) return Paint::bad;
  if (boot == ready) return Paint::good;
  return boot == booting ? Paint::warning : Paint::dim;
}

Paint load_paint(double load) {
  if (load > 0.9) return Paint::bad;
  return load > 0.7 ? Paint::warning : Paint::good;
}

Paint count_paint(std::int64_t count) { return count == 0 ? Paint::dim : Paint::warning; }

Line bus_line(const status_t& status) {
  static constexpr const char* states[] = {"error active", "error passive", "BUS OFF",
                                           "INTERFACE DOWN"};
  const auto state = static_cast<std::size_t>(std::clamp<int>(status.bus_state, 0, 3));
  return Line{}
      .add(status.bus, Paint::title)
      .add(fmt::format(" on {}  {} kbit/s  ", status.interface, status.bitrate / 1000))
      .add(states[state], state == 0 ? Paint::good : Paint::bad)
      .add(fmt::format("  {:.3f} ms  cycle {}", static_cast<double>(status.period_ns) / 1e6,
                       status.cycle))
      .add(fmt::format("  missed {}", status.cycles_missed), count_paint(status.cycles_missed))
      .add(fmt::format("  late {}", status.cycles_late), count_paint(status.cycles_late));
}

Line load_line(const status_t& status) {
  return Line{}
      .add("load ")
      .add(bar(status.bus_load, 20), load_paint(status.bus_load))
      .add(fmt::format(" {:>3.0f} %   ", 100.0 * status.bus_load))
      .add(fmt::format("{} in  {} out", status.frames_received, status.frames_sent), Paint::dim)
      .add(fmt::format("  not sent {}", status.send_failures), count_paint(status.send_failures))
      .add(fmt::format("  lost {}", status.receive_overruns), count_paint(status.receive_overruns))
      .add(fmt::format("  error frames {}", status.error_frames), count_paint(status.error_frames));
}

Line diagnosis_line(const diagnosis_t& diagnosis) {
  Line line;
  line.add("bus ")
      .add(bus_condition(diagnosis.state), diagnosis.state == 0 ? Paint::good : Paint::bad)
      .add(fmt::format("   nodes not ok {}", diagnosis.nodes_not_ok),
           diagnosis.nodes_not_ok == 0 ? Paint::dim : Paint::bad)
      .add(fmt::format("  SYNCs {}", diagnosis.sync_count), Paint::dim)
      .add(fmt::format("  no outputs {}", diagnosis.outputs_skipped),
           count_paint(diagnosis.outputs_skipped))
      .add(fmt::format("  incomplete {}", diagnosis.images_incomplete),
           count_paint(diagnosis.images_incomplete));
  if (diagnosis.warning_limit != 0) line.add("  WARNING LIMIT", Paint::bad);
  if (diagnosis.rx_queue_exceeded != 0) line.add("  RECEIVE QUEUE EXCEEDED", Paint::bad);
  if (diagnosis.tx_queue_exceeded != 0) line.add("  SEND QUEUE EXCEEDED", Paint::bad);
  if (diagnosis.send_error != 0) line.add("  SEND ERROR", Paint::bad);
  return line;
}

/// Returns the line about the SYNC of a foreign producer.
Line sync_line(const sync_status_t& sync) {
  const bool locked = sync.state == static_cast<int>(SyncState::locked);
  const bool lost = sync.state == static_cast<int>(SyncState::lost);
  return Line{}
      .add("SYNC ")
      .add(sync.text, locked ? Paint::good
                      : lost ? Paint::bad
                             : Paint::warning)
      .add(fmt::format("   lost {} times", sync.losses), count_paint(sync.losses));
}

Line node_line(const node_status_t& node) {
  const std::string age =
      node.heartbeat_age_ms < 0 ? "-" : std::to_string(node.heartbeat_age_ms) + " ms";
  const std::string emcy =
      node.emcy_count == 0 ? "-"
                           : fmt::format("{} x {:04X}", node.emcy_count, node.last_emcy & 0xFFFF);
  return Line{}
      .add(right(std::to_string(node.node_id), 5))
      .add("  ")
      .add(left(node.name, 18), Paint::title)
      .add(left(nmt_name(node.nmt_state), 17), nmt_paint(node.nmt_state))
      .add(left(boot_name(node), 16), boot_paint(node.boot_state))
      .add(right(age, 10))
      .add(right(emcy, 13), node.emcy_count == 0 ? Paint::dim : Paint::bad)
      .add(right(std::to_string(node.pdos_missing), 9), count_paint(node.pdos_missing))
      .add("  ")
      .add(node.holder.empty() ? "-" : node.holder, Paint::dim);
}

const histogram_t* find(const timing_t& timing, std::string_view name) {
  const auto found = std::ranges::find(timing.histograms, name, &histogram_t::name);
  return found == timing.histograms.end() || found->count == 0 ? nullptr : &*found;
}

Line timing_line(const timing_t& timing) {
  Line line;
  for (const char* const name : {"sync_lateness", "sync_to_publish", "command_age"}) {
    const histogram_t* const times = find(timing, name);
    if (times == nullptr) continue;
    line.add(fmt::format("{} ", timing_label(name)), Paint::dim)
        .add(fmt::format("{:.0f} us", static_cast<double>(times->median)))
        .add(fmt::format(" (p99 {:.0f}, max {:.0f})   ", static_cast<double>(times->p99),
                         static_cast<double>(times->maximum)),
             Paint::dim);
  }
  return line;
}

std::string si_text(double value) {
  if (!std::isfinite(value)) return fmt::format("{}", value);
  const double magnitude = std::abs(value);
  if (magnitude != 0 && (magnitude < 1e-3 || magnitude >= 1e7)) return fmt::format("{:.4e}", value);
  return fmt::format("{:.4f}", value);
}

Line signal_line(const BusView& bus, std::size_t at, double si) {
  const signal_t& signal = bus.signals()[at];
  const bool scaled = !signal.unit.empty();
  const auto type = static_cast<DataType>(signal.data_type);
  const bool stale = bus.stale(at);
  return Line{}
      .add(left(signal.node + "." + signal.name, 44), stale ? Paint::bad : Paint::plain)
      .add(fmt::format("{:04X}:{:02X} ", signal.index & 0xFFFF, signal.sub & 0xFF), Paint::dim)
      .add(signal.output ? "out " : "in  ", Paint::dim)
      .add(right(scaled ? si_text(si) : std::string{}, 14))
      .add(" " + left(signal.unit, 8))
      .add(right(is_real(type) ? fmt::format("{:g}", number_of(type, bus.values()[at]))
                               : std::to_string(bus.values()[at]),
                 14),
           scaled ? Paint::dim : Paint::plain)
      .add(stale ? "  stale" : "", Paint::bad);
}

/// Sorts the signals by node and then in the order of the layout, because people look for a node.
std::vector<std::size_t> by_node(const std::vector<signal_t>& signals) {
  std::vector<std::size_t> order(signals.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::ranges::stable_sort(order, {}, [&](std::size_t at) { return signals[at].node_id; });
  return order;
}

/// Adds the signals that fit into `room` lines, from `wanted` on, and a line that says which of all
/// signals they are. Returns the first signal that is shown.
std::size_t add_signals(std::vector<Line>& lines, const BusView& bus, std::size_t wanted,
                        std::size_t room) {
  if (bus.values().empty()) {
    lines.push_back(Line{}.add("waiting for the layout and an image ...", Paint::dim));
    lines.push_back(Line{});
    return wanted;
  }
  Eigen::ArrayXd si{static_cast<Eigen::Index>(bus.values().size())};
  bus.units().to_si(bus.values(), si);
  const std::vector<std::size_t> order = by_node(bus.signals());
  const std::size_t shown = std::min(room, order.size());
  const std::size_t first = std::min(wanted, order.size() - shown);
  for (std::size_t i = first; i < first + shown; ++i) {
    lines.push_back(signal_line(bus, order[i], si[static_cast<Eigen::Index>(order[i])]));
  }
  Line which;
  if (shown < order.size()) {
    which.add(fmt::format("[{}-{} of {}, arrows scroll]", first + 1, first + shown, order.size()),
              Paint::dim);
  }
  lines.push_back(std::move(which));
  return first;
}

Line event_line(const event_t& event) {
  static constexpr Paint paints[] = {Paint::plain, Paint::warning, Paint::bad};
  const std::time_t seconds = event.utime / 1'000'000;
  const std::string_view text{event.text};
  return Line{}
      .add(fmt::format("{:%H:%M:%S} ", fmt::localtime(seconds)), Paint::dim)
      .add(text.substr(0, text.find('\n')), paints[std::clamp<int>(event.severity, 0, 2)]);
}

}  // namespace

std::string nmt_name(int state) {
  std::string text{name(static_cast<NmtState>(state))};
  std::ranges::transform(text, text.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

std::string bus_condition(int state) {
  static constexpr const char* conditions[] = {"running", "starting", "offline", "stopped"};
  return conditions[std::clamp(state, 0, 3)];
}

std::string stop_name(int stop) {
  static constexpr const char* names[] = {"none", "under way", "confirmed", "not confirmed"};
  return names[std::clamp(stop, 0, 3)];
}

std::string boot_name(const node_status_t& node) {
  const auto state = static_cast<BootState>(node.boot_state);
  if (state == BootState::booting) {
    return fmt::format("step {} of {}", node.boot_step + 1, node.boot_steps);
  }
  return state == BootState::failed ? "boot failed" : std::string{name(state)};
}

namespace {

/// Adds the state of the ordered stop, or nothing while no stop is requested.
void add_stop(std::vector<Line>& lines, const status_t& status) {
  if (status.stop == 0) return;
  const bool bad = status.stop == static_cast<int>(StopResult::unconfirmed);
  const Paint paint = bad ? Paint::bad : Paint::plain;
  lines.push_back(Line{}.add(" ordered stop " + stop_name(status.stop), paint));
  std::istringstream axes{status.stop_text};
  for (std::string axis; std::getline(axes, axis);) {
    lines.push_back(Line{}.add("   " + axis, Paint::bad));
  }
}

}  // namespace

std::vector<Line> status_lines(const BusView& bus) {
  const status_t& status = *bus.status();
  std::vector<Line> lines{bus_line(status), load_line(status), diagnosis_line(status.diagnosis)};
  if (bus.sync() && bus.sync()->timeout_ns != 0) lines.push_back(sync_line(*bus.sync()));
  add_stop(lines, status);
  lines.push_back(
      Line{}.add(" NODE  NAME              STATE            BOOT             HEARTBEAT         "
                 "EMCY  NO PDO  HELD BY",
                 Paint::dim));
  for (const node_status_t& node : status.nodes) lines.push_back(node_line(node));
  return lines;
}

TopFrame top_frame(const BusView& bus, const TopOptions& options) {
  if (!bus.status()) return {};
  TopFrame frame{.lines = status_lines(bus)};
  std::vector<Line>& lines = frame.lines;
  if (bus.timing()) lines.insert(lines.begin() + 3, timing_line(*bus.timing()));
  lines.push_back(Line{}.add("real time: " + bus.status()->realtime, Paint::dim));
  if (bus.two_daemons()) {
    lines.push_back(Line{}.add("two daemons run a bus of this name", Paint::bad));
  }
  lines.push_back(Line{});
  const std::size_t messages = message_lines(options.rows);
  const std::size_t used = lines.size() + 1 + messages;
  const std::size_t room = options.rows == 0 ? bus.signals().size()
                                             : std::max<std::size_t>(options.rows, used + 3) - used;
  frame.first_signal = add_signals(lines, bus, options.first_signal, room);
  const std::size_t count = std::min(messages, bus.events().size());
  for (std::size_t i = bus.events().size() - count; i < bus.events().size(); ++i) {
    lines.push_back(event_line(bus.events()[i]));
  }
  return frame;
}

}  // namespace takt
