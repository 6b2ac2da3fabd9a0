#include <nlohmann/json.hpp>

#include "apps/takt/simulate/outcome_report.hpp"
#include "master/explain/boot_report.hpp"

namespace takt {
namespace {

using Json = nlohmann::ordered_json;

double ms(Time time) { return static_cast<double>(time.count()) / 1e6; }

Json cycles_json(const SimulationOutcome& outcome) {
  const BusStatus& loop = outcome.loop;
  return {{"period_us", us(outcome.period)},
          {"count", loop.beats},
          {"missed", loop.cycles_missed},
          {"late", loop.cycles_late},
          {"images_incomplete", loop.images_incomplete},
          {"outputs_skipped", loop.outputs_skipped}};
}

Json bus_json(const SimulationOutcome& outcome) {
  const double seconds = std::chrono::duration<double>(outcome.simulated).count();
  const double rate = outcome.bitrate;
  const double cycle_bits = rate * std::chrono::duration<double>(outcome.period).count();
  return {{"bitrate", outcome.bitrate},
          {"frames", outcome.wire.frames},
          {"bits", outcome.wire.bits},
          {"load_percent", 100.0 * static_cast<double>(outcome.wire.bits) / (rate * seconds)},
          {"worst_cycle_load_percent",
           100.0 * static_cast<double>(outcome.worst_cycle_bits) / cycle_bits},
          {"sdo_frames", outcome.sdo_frames},
          {"emcy_frames", outcome.emcy_frames},
          {"error_frames", outcome.wire.error_frames},
          {"lost_by_fault", outcome.wire.lost},
          {"duplicated_by_fault", outcome.wire.duplicated},
          {"expired", outcome.wire.expired},
          {"queue_overflows", outcome.wire.overflowed},
          {"send_failures", outcome.loop.send_failures}};
}

Json sync_json(const SyncOnWire& sync) {
  if (sync.count < 2) return {{"count", sync.count}};
  return {{"count", sync.count},
          {"shortest_us", us(sync.shortest)},
          {"longest_us", us(sync.longest)},
          {"gaps", sync.gaps},
          {"jitter_p50_us", us(sync.quantile(0.5))},
          {"jitter_p99_us", us(sync.quantile(0.99))},
          {"jitter_max_us", us(sync.quantile(1.0 - 1e-12))}};
}

Json node_json(const NodeOutcome& node) {
  return {{"name", node.name},
          {"node", node.id},
          {"state", std::string{name(node.status.nmt)}},
          {"boot", std::string{name(node.status.boot)}},
          {"boot_time_ms", node.first_boot ? Json(ms(*node.first_boot)) : Json(nullptr)},
          {"boots", node.status.boot_count},
          {"boot_failures", node.boot_failures},
          {"heartbeats_lost", node.status.heartbeat_lost},
          {"emcy", node.status.emcy_count},
          {"sdo_aborts", node.status.sdo_aborts},
          {"tpdo_frames", node.tpdo_frames},
          {"tpdo_missing", node.tpdo_missing},
          {"tpdo_late", node.tpdo_late},
          {"tpdo_worst_us", us(node.worst_tpdo)},
          {"rpdo_frames", node.rpdo_frames}};
}

Json motion_json(const MotionOutcome& motion) {
  const auto time = [](const std::optional<Time>& when) {
    return when ? Json(ms(*when)) : Json(nullptr);
  };
  const auto of_position = [](const AxisMaxima& axis, double value) {
    return axis.speed_word ? Json(nullptr) : Json(value);
  };
  Json axes = Json::array();
  for (const AxisMaxima& axis : motion.axes) {
    axes.push_back({{"axis", axis.axis},
                    {"unit", axis.unit},
                    {"largest_velocity", axis.velocity},
                    {"largest_acceleration", of_position(axis, axis.acceleration)},
                    {"largest_following_error", of_position(axis, axis.following_error)}});
  }
  return {{"program", motion.program},
          {"kind", std::string{name(motion.kind)}},
          {"line", motion.pos.line},
          {"begin_ms", time(motion.begin)},
          {"end_ms", time(motion.end)},
          {"result", motion.result},
          {"text", motion.text},
          {"expect", motion.expect},
          {"as_expected", motion.as_expected()},
          {"axes", std::move(axes)}};
}

Json front_json(const FrontOutcome& front) {
  Json refused = Json::object();
  for (std::size_t i = 0; i < front.refused.size(); ++i) {
    refused[std::string{name(static_cast<CommandRefusal>(i))}] = front.refused[i];
  }
  Json applications = Json::array();
  for (const ApplicationOutcome& one : front.applications) {
    applications.push_back({{"name", one.name},
                            {"images_used", one.images},
                            {"commands_sent", one.commands},
                            {"queue_overflows", one.lost}});
  }
  return {{"starts", front.starts},
          {"images_published", front.images},
          {"commands_taken", front.commands_taken},
          {"commands_refused", std::move(refused)},
          {"damaged_messages", front.damaged},
          {"gaps", front.gaps},
          {"queue_overflows", front.lost},
          {"fallbacks", front.fallbacks},
          {"applications", std::move(applications)}};
}

}  // namespace

void print_json(std::ostream& out, const SimulationOutcome& outcome) {
  Json root{{"bus", outcome.bus},
            {"seed", outcome.seed},
            {"simulated_s", std::chrono::duration<double>(outcome.simulated).count()},
            {"cycles", cycles_json(outcome)},
            {"wire", bus_json(outcome)},
            {"sync", sync_json(outcome.sync)}};
  root["nodes"] = Json::array();
  for (const NodeOutcome& node : outcome.nodes) root["nodes"].push_back(node_json(node));
  root["move"] = {{"built_in_sine", outcome.move}, {"axes_moved", outcome.axes_moved}};
  if (outcome.front) root["front"] = front_json(*outcome.front);
  if (outcome.programs != 0) {
    root["motions"] = Json::array();
    for (const MotionOutcome& one : outcome.motions) root["motions"].push_back(motion_json(one));
  }
  root["stopped_in_order"] = outcome.stopped && outcome.stop == StopResult::confirmed;
  root["stop"] = {{"ended", outcome.stopped},
                  {"confirmed", outcome.stop == StopResult::confirmed},
                  {"unconfirmed", outcome.unconfirmed}};
  root["events_total"] = outcome.events_total;
  root["events"] = Json::array();
  for (const ReportedEvent& event : outcome.events) {
    root["events"].push_back({{"time_ms", ms(event.when)},
                              {"kind", std::string{name(event.kind)}},
                              {"node", event.node},
                              {"text", event.text}});
  }
  out << root.dump(2, ' ', false, Json::error_handler_t::replace) << '\n';
}

}  // namespace takt
