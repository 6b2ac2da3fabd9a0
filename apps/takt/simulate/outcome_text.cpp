#include <algorithm>
#include <fmt/format.h>
#include <numeric>

#include "apps/takt/simulate/outcome_report.hpp"
#include "master/explain/boot_report.hpp"
#include "master/lcm/printable_text.hpp"

namespace takt {
namespace {

constexpr std::size_t shown_events = 40;

double seconds(Time time) { return std::chrono::duration<double>(time).count(); }

void print_bus(std::ostream& out, const SimulationOutcome& outcome) {
  const double bits = static_cast<double>(outcome.wire.bits);
  const double rate = outcome.bitrate;
  const double worst = static_cast<double>(outcome.worst_cycle_bits);
  out << fmt::format("{}: {:.3f} s of bus at {} kbit/s, seed {}\n", outcome.bus,
                     seconds(outcome.simulated), outcome.bitrate / 1000, outcome.seed)
      << fmt::format(
             "  cycles       {} of {:.0f} us, {} missed, {} without outputs, {} with a missing "
             "PDO\n",
             outcome.loop.beats, us(outcome.period), outcome.loop.cycles_missed,
             outcome.loop.outputs_skipped, outcome.loop.images_incomplete)
      << fmt::format("  frames       {} ({} SDO, {} EMCY), {} error frames\n", outcome.wire.frames,
                     outcome.sdo_frames, outcome.emcy_frames, outcome.wire.error_frames)
      << fmt::format("  bus load     {:.1f} %, fullest cycle {:.1f} %\n",
                     100 * bits / (rate * seconds(outcome.simulated)),
                     100 * worst / (rate * seconds(outcome.period)));
  if (outcome.wire.lost + outcome.wire.duplicated + outcome.wire.overflowed != 0) {
    out << fmt::format("  faults       {} frames lost, {} duplicated, {} dropped by a full queue\n",
                       outcome.wire.lost, outcome.wire.duplicated, outcome.wire.overflowed);
  }
}

void print_sync(std::ostream& out, const SyncOnWire& sync) {
  if (sync.count < 2) {
    out << "  SYNC         no SYNC on the wire\n";
    return;
  }
  out << fmt::format(
      "  SYNC         distance {:.0f} to {:.0f} us, off by p50 {:.0f} p99 {:.0f} max {:.0f} us, "
      "{} gaps\n",
      us(sync.shortest), us(sync.longest), us(sync.quantile(0.5)), us(sync.quantile(0.99)),
      us(sync.quantile(1.0 - 1e-12)), sync.gaps);
}

std::string refusals_text(const FrontOutcome& front) {
  std::string text;
  for (std::size_t i = 0; i < front.refused.size(); ++i) {
    if (front.refused[i] == 0) continue;
    text += fmt::format("{}{} {}", text.empty() ? " (" : ", ", front.refused[i],
                        name(static_cast<CommandRefusal>(i)));
  }
  return text.empty() ? text : text + ")";
}

std::string sources_text(const SimulationOutcome& outcome) {
  const std::size_t applications = outcome.front->applications.size();
  std::string text;
  if (applications != 0) text = fmt::format("{} applications over LCM", applications);
  if (outcome.programs == 0) return text;
  return fmt::format("{}{}{} program{} with motions", text, text.empty() ? "" : ", ",
                     outcome.programs, outcome.programs == 1 ? "" : "s");
}

void print_front(std::ostream& out, const SimulationOutcome& outcome) {
  const FrontOutcome& front = *outcome.front;
  const auto refused = std::accumulate(front.refused.begin(), front.refused.end(), 0ULL);
  out << fmt::format("  set-points   {}; {} axes moved\n", sources_text(outcome),
                     outcome.axes_moved)
      << fmt::format("  front thread {} images published, {} commands taken, {} refused{}\n",
                     front.images, front.commands_taken, refused, refusals_text(front))
      << fmt::format(
             "               {} gaps, {} damaged messages, {} dropped by a full queue, {} outputs "
             "took their fallback, {} starts\n",
             front.gaps, front.damaged, front.lost, front.fallbacks, front.starts);
  for (const ApplicationOutcome& one : front.applications) {
    out << fmt::format(
        "  {:12} {} images used, {} commands sent, {} messages dropped by a full queue\n", one.name,
        one.images, one.commands, one.lost);
  }
}

void print_stop(std::ostream& out, const SimulationOutcome& outcome) {
  const bool confirmed = outcome.stop == StopResult::confirmed;
  const char* const declared = !outcome.stopped ? "NOT in time"
                               : confirmed      ? "in order"
                                                : "NOT confirmed";
  out << fmt::format("  stop         {}\n", declared);
  for (const std::string& axis : outcome.unconfirmed)
    out << fmt::format("               {}\n", axis);
}

void print_motions(std::ostream& out, const SimulationOutcome& outcome) {
  if (outcome.programs == 0) return;
  const std::size_t unexpected = unexpected_ends(outcome.motions);
  out << fmt::format("  motions      {} of {} ended as expected\n",
                     outcome.motions.size() - unexpected, outcome.motions.size());
  const auto time = [](const std::optional<Time>& when) {
    return when ? fmt::format("{:.3f}", seconds(*when)) : "-";
  };
  out << fmt::format("\n  {:>4}  {:12} {:8} {:>9} {:>9}  {}\n", "line", "program", "motion",
                     "begin s", "end s", "result");
  for (const MotionOutcome& motion : outcome.motions) {
    const std::string judged =
        motion.as_expected() ? std::string{} : fmt::format(" (NOT `{}`)", motion.expect);
    out << fmt::format("  {:>4}  {:12} {:8} {:>9} {:>9}  {}{}{}{}\n", motion.pos.line,
                       motion.program, name(motion.kind), time(motion.begin), time(motion.end),
                       motion.result, judged, motion.text.empty() ? "" : ": ",
                       printable_text(motion.text));
    for (const AxisMaxima& axis : motion.axes) {
      if (axis.velocity == 0.0) continue;
      if (axis.speed_word) {
        out << fmt::format("        {}: at most {:.4g} {}\n", axis.axis, axis.velocity, axis.unit);
        continue;
      }
      out << fmt::format(
          "        {}: at most {:.4g} {}/s, {:.4g} {}/s^2, following error {:.3g} {}\n", axis.axis,
          axis.velocity, axis.unit, axis.acceleration, axis.unit, axis.following_error, axis.unit);
    }
  }
}

void print_nodes(std::ostream& out, const SimulationOutcome& outcome) {
  out << fmt::format("\n  {:>3}  {:16} {:16} {:8} {:>9} {:>9} {:>7} {:>6} {:>10} {:>9} {:>5}\n",
                     "id", "node", "state", "boot", "boot ms", "TPDOs", "missing", "late",
                     "worst us", "RPDOs", "EMCY");
  for (const NodeOutcome& node : outcome.nodes) {
    const std::string boot =
        node.first_boot ? fmt::format("{:.1f}", us(*node.first_boot) / 1e3) : "-";
    out << fmt::format("  {:>3}  {:16} {:16} {:8} {:>9} {:>9} {:>7} {:>6} {:>10.0f} {:>9} {:>5}\n",
                       node.id, node.name, name(node.status.nmt), name(node.status.boot), boot,
                       node.tpdo_frames, node.tpdo_missing, node.tpdo_late, us(node.worst_tpdo),
                       node.rpdo_frames, node.status.emcy_count);
  }
}

void print_events(std::ostream& out, const SimulationOutcome& outcome) {
  out << fmt::format("\n  {} events{}\n", outcome.events_total,
                     outcome.events_total > shown_events
                         ? fmt::format(", the first {} (--json: more)", shown_events)
                         : "");
  for (std::size_t i = 0; i < std::min(shown_events, outcome.events.size()); ++i) {
    out << fmt::format("  {:>11.3f} ms  {}\n", us(outcome.events[i].when) / 1e3,
                       printable_text(outcome.events[i].text));
  }
}

}  // namespace

void print_text(std::ostream& out, const SimulationOutcome& outcome) {
  print_bus(out, outcome);
  print_sync(out, outcome.sync);
  if (outcome.front) {
    print_front(out, outcome);
  } else if (outcome.move) {
    out << fmt::format("  set-points   built-in sine, no application; {} axes moved\n",
                       outcome.axes_moved);
  } else {
    out << "  set-points   none (no application; --move gives a built-in sine)\n";
  }
  print_stop(out, outcome);
  print_motions(out, outcome);
  print_nodes(out, outcome);
  print_events(out, outcome);
}

}  // namespace takt
