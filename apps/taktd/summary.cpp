#include "apps/taktd/summary.hpp"

#include <fmt/format.h>

#include "master/lcm/printable_text.hpp"

namespace takt {
namespace {

double milliseconds(Time time) { return static_cast<double>(time.count()) / 1e6; }
double microseconds(Time time) { return static_cast<double>(time.count()) / 1e3; }

std::string times_line(const char* what, const Histogram& histogram) {
  const HistogramSnapshot times = histogram.snapshot();
  if (times.total() == 0) return {};
  return fmt::format("  {:<18} median {:.1f} us, p99 {:.1f} us, longest {:.1f} us\n", what,
                     microseconds(times.percentile(0.5)), microseconds(times.percentile(0.99)),
                     microseconds(times.maximum()));
}

}  // namespace

std::string plan_summary(const LoadedNetwork& network) {
  const BusPlan& plan = network.plan;
  std::string text = fmt::format(
      "bus {}: {} nodes, {} bit/s, {} every {} ms\n", plan.name, plan.nodes.size(), plan.bitrate,
      plan.cycle.sync ? "SYNC" : "image", milliseconds(plan.cycle.period));
  text += fmt::format("  {} TPDOs, {} RPDOs, {} inputs, {} outputs\n", plan.pdos.tpdos.size(),
                      plan.pdos.rpdos.size(), plan.layout.inputs, plan.layout.outputs());
  for (const NodePlan& node : plan.nodes) {
    text += fmt::format("  node {:>3} {:<16} {:>3} boot steps, {}{}\n", node.id.value(), node.name,
                        node.boot_plan.steps.size(), node.description_file,
                        node.mandatory ? ", mandatory" : "");
  }
  return printable_lines(text);  // the names of device files come from the network file
}

std::string run_summary(const MasterRun& master, const Bridge& bridge, std::uint64_t errors,
                        std::uint64_t warnings) {
  const BusStatus& bus = bridge.status().bus;
  const TimingHistograms& timing = master.timing();
  std::string text = fmt::format(
      "{} cycles, {} missed, {} late, {} without outputs, {} with a missing PDO\n", bus.beats,
      bus.cycles_missed, bus.cycles_late, bus.outputs_skipped, bus.images_incomplete);
  text += times_line("SYNC lateness", timing.sync_lateness);
  text += times_line("SYNC to image", timing.sync_to_publish);
  text += times_line("SYNC to LCM", bridge.sync_to_lcm());
  text += times_line("command age", timing.command_age);
  text += fmt::format("  frames             {} received, {} sent, {} not sent, {} lost\n",
                      bus.frames_received, bus.frames_sent, bus.send_failures,
                      bus.port.receive_overruns);
  text += fmt::format("  images on LCM      {}, {} lost before sending\n", bridge.images(),
                      master.image_overruns());
  text += fmt::format("  commands           {} accepted, {} refused\n", bridge.commands_taken(),
                      bridge.commands_refused());
  text += fmt::format("  events             {} errors, {} warnings", errors, warnings);
  return text;
}

}  // namespace takt
