#include "eds_parser/plan/cycle_compiler.hpp"
#include "eds_parser/print/json.hpp"
#include "eds_parser/print/names.hpp"
#include "eds_parser/print/plan/plan_names.hpp"
#include "eds_parser/print/plan/plan_waits.hpp"
#include "eds_parser/print/plan/print_plan.hpp"
#include "eds_parser/print/plan/step_frames.hpp"
#include "eds_parser/table/output_limits.hpp"
#include "eds_parser/values/little_endian.hpp"
#include "eds_parser/values/name_of.hpp"

namespace takt {
namespace {

std::string source_of_sync(const CyclePlan& cycle) {
  if (!cycle.sync) return "none";
  if (!cycle.sync_followed) return "master";
  return cycle.sync_producer ? "node " + std::to_string(cycle.sync_producer->value()) : "external";
}

Json cycle_json(const BusPlan& plan) {
  const CyclePlan& c = plan.cycle;
  const TimeBudget budget = time_budget(plan);
  return {{"period_us", us(c.period)},
          {"sync", c.sync},
          {"sync_cob_id", c.sync_cob_id.id()},
          {"sync_overflow", c.sync_overflow},
          {"time_period_us", us(plan.time.period)},
          {"time_cob_id", plan.time.cob_id.id()},
          {"sync_source", source_of_sync(c)},
          {"sync_timeout_us", us(c.sync_timeout)},
          {"receive_window_us", us(c.receive_window)},
          {"output_deadline_us", us(c.output_deadline)},
          {"quiet_before_sync_us", us(c.quiet_before_sync)},
          {"sync_window_us", us(c.sync_window)},
          {"service_frames", c.service_frames},
          {"inputs_wire_us", us(budget.inputs_wire)},
          {"outputs_wire_us", us(budget.outputs_wire)},
          {"compute_from_us", us(budget.earliest)},
          {"compute_until_us", us(budget.latest)},
          {"acts_at_sync", budget.next_sync ? "k+1" : "k+2"}};
}

Json pdo_json(const BusPlan& plan, const PdoRow& row) {
  Json fields = Json::array();
  for (const PdoField& field : plan.pdos.fields_of(row)) {
    const Signal& signal = plan.layout.signals[field.signal];
    fields.push_back({{"signal", field.signal},
                      {"name", signal.name},
                      {"index", signal.object.index},
                      {"sub", signal.object.sub},
                      {"bit_offset", field.bit_offset},
                      {"bits", field.bits}});
  }
  return {{"number", row.number},
          {"cob_id", row.cob_id.id()},
          {"extended", row.cob_id.is_extended()},
          {"transmission_type", row.transmission},
          {"length", row.length},
          {"sync_start", row.sync_start},
          {"inhibit_us", us(row.inhibit)},
          {"event_timer_us", us(row.event_timer)},
          {"deadline_us", us(row.deadline)},
          {"poll_us", us(row.poll)},
          {"poll_syncs", row.poll_syncs},
          {"late", row.drop_late ? "drop" : "use"},
          {"on_request", row.on_request},
          {"mpdo_header", row.header},
          {"fields", std::move(fields)}};
}

Json pdos_json(const BusPlan& plan, const std::vector<PdoRow>& rows, std::size_t node_index) {
  Json list = Json::array();
  for (const PdoRow& row : rows) {
    if (row.node_index == node_index) list.push_back(pdo_json(plan, row));
  }
  return list;
}

Json step_json(const BootStep& step, std::size_t number, const StepFrames& frames) {
  Json out{{"step", number},
           {"action", action_name(step.action)},
           {"letter", std::string(1, step.letter)},
           {"purpose", step.purpose},
           {"timeout_us", us(step.timeout)}};
  if (step.action == BootAction::nmt) out["command"] = command_name(step.command);
  const bool jumps =
      step.action == BootAction::skip_if_same || step.action == BootAction::await_alive;
  if (jumps) out["target"] = step.target + 1;
  if (step.object.index != 0) {
    out["index"] = step.object.index;
    out["sub"] = step.object.sub;
  }
  if (!step.value.empty()) out["value"] = value_text(step);
  if (step.mask != 0xFFFF'FFFF) out["mask"] = step.mask;
  if (step.optional) out["optional"] = true;
  if (!frames.first.empty()) out["frame"] = frames.first;
  if (!frames.write.empty()) out["write_frame"] = frames.write;
  return out;
}

/// Returns the object's key in `identity`, or an empty text if it is another object.
std::string_view identity_key(ObjectKey object) {
  static constexpr std::string_view names[]{"", "vendor_id", "product_code", "revision_number",
                                            "serial_number"};
  if (object == ObjectKey{0x1000, 0}) return "device_type";
  return object.index == 0x1018 && object.sub < std::size(names) ? names[object.sub] : "";
}

/// Returns the identity that the boot expects: `{"device_type": 131474, "vendor_id": 59}`.
Json identity_json(const BootPlan& boot) {
  Json out = Json::object();
  for (const BootStep& step : boot.steps) {
    const std::string key{identity_key(step.object)};
    if (step.action != BootAction::expect || key.empty() || step.value.size() > 4) continue;
    out[key] = from_little_endian(step.value);
  }
  return out;
}

std::string_view loss_name(LossReaction reaction) {
  static constexpr std::string_view names[]{"report", "stop_node", "stop_group", "quick_stop"};
  return name_of(reaction, names);
}

/// Returns the axes for which the network file has `homing:`.
Json homing_json(const NodePlan& node) {
  Json axes = Json::array();
  for (const AxisPlan& axis : node.axes) {
    if (!axis.homing) continue;
    axes.push_back({{"axis", axis.number + 1},
                    {"required", axis.homing->required},
                    {"method", axis.homing->method ? Json(*axis.homing->method) : Json()},
                    {"timeout_us", us(axis.homing->timeout)}});
  }
  return axes;
}

Json node_json(const BusPlan& plan, std::size_t index) {
  const NodePlan& node = plan.nodes[index];
  Json steps = Json::array();
  const std::vector<StepFrames> frames = step_frames(node);
  for (std::size_t i = 0; i < node.boot_plan.steps.size(); ++i) {
    steps.push_back(step_json(node.boot_plan.steps[i], i + 1, frames[i]));
  }
  return {{"id", node.id.value()},
          {"name", node.name},
          {"file", node.description_file},
          {"product_name", node.product_name},
          {"identity", identity_json(node.boot_plan)},
          {"boot", node.boot},
          {"mandatory", node.mandatory},
          {"cia402", node.cia402},
          {"heartbeat_timeout_us", us(node.heartbeat_timeout)},
          {"guard_time_us", us(node.guard.period)},
          {"guard_life_time_us", us(node.guard.life_time())},
          {"emcy_cob_id", node.emcy_cob_id.value_or(CobId::base(0x080U + node.id.value())).id()},
          {"on_loss", loss_name(node.on_loss)},
          {"group", node.group == 0 ? "" : plan.groups[node.group - 1U]},
          {"sdo_request_cob_id", node.sdo.channel_of(node.id).request.id()},
          {"sdo_answer_cob_id", node.sdo.channel_of(node.id).answer.id()},
          {"sdo_timeout_us", us(node.sdo_timeout)},
          {"reboot_delay_us", us(node.reboot_delay)},
          {"reboot_delay_max_us", us(node.longest_reboot_delay)},
          {"lss", node.lss.has_value()},
          {"device_data", node.device_data},
          {"device_data_file", node.device_data_file},
          {"device_notes", node.device_notes},
          {"homing", homing_json(node)},
          {"tpdos", pdos_json(plan, plan.pdos.tpdos, index)},
          {"rpdos", pdos_json(plan, plan.pdos.rpdos, index)},
          {"boot_plan", std::move(steps)}};
}

Json signal_json(const BusPlan& plan, std::size_t index) {
  const Signal& signal = plan.layout.signals[index];
  Json out{{"signal", index},
           {"node", plan.nodes[signal.node_index].name},
           {"node_id", signal.node.value()},
           {"name", signal.name},
           {"index", signal.object.index},
           {"sub", signal.object.sub},
           {"direction", signal.output ? "out" : "in"},
           {"data_type", name(signal.type)},
           {"bits", signal.bits},
           {"unit", signal.unit},
           {"scale", signal.scale},
           {"offset", signal.offset}};
  if (!signal.output) return out;
  out["fallback"] = signal.fallback == Fallback::hold ? "hold" : "value";
  if (signal.fallback == Fallback::value) out["fallback_value"] = signal.fallback_value;
  out["fallback_cycles"] = signal.fallback_cycles;
  out["safe_value"] = or_null(signal.safe_value);
  out["seeded_from"] = or_null(signal.seeded_from);
  return out;
}

Json limit_json(const BusPlan& plan, const LimitLine& line) {
  const bool of_object = line.object.index != 0;
  Json out{{"node", plan.nodes[line.node_index].name},
           {"axis", line.axis == 0 ? Json(nullptr) : Json(line.axis)},
           {"index", of_object ? Json(line.object.index) : Json(nullptr)},
           {"sub", of_object ? Json(line.object.sub) : Json(nullptr)},
           {"limit", name(line.kind)},
           {"source", name(line.source)},
           {"low", or_null(line.low)},
           {"high", or_null(line.high)},
           {"unit", line.unit},
           {"signals", line.signals}};
  for (const LimitSum& sum : sums_of(plan.limits, line)) {
    out["sums"].push_back(Json::array({sum.target, sum.offset}));
  }
  if (line.source == LimitSource::none) {
    out["proposal"] = line.proposal;
    out["because"] = line.because;
  }
  return out;
}

Json waits_json(const BusPlan& plan) {
  return list_of(plan_waits(plan), [](const PlanWait& wait) {
    return Json{{"wait", wait.wait}, {"limit_us", us(wait.limit)}, {"what", wait.what}};
  });
}

}  // namespace

void print_plan_json(std::ostream& out, const BusPlan& plan, const PlanPrint& what) {
  const auto wanted = [&](NodeId node) { return !what.node || *what.node == node; };
  Json nodes = Json::array();
  Json signals = Json::array();
  Json limits = Json::array();
  for (std::size_t i = 0; i < plan.nodes.size(); ++i) {
    if (wanted(plan.nodes[i].id)) nodes.push_back(node_json(plan, i));
  }
  for (std::size_t i = 0; i < plan.layout.signals.size(); ++i) {
    if (wanted(plan.layout.signals[i].node)) signals.push_back(signal_json(plan, i));
  }
  for (const LimitLine& line : plan.limits.lines) {
    if (wanted(plan.nodes[line.node_index].id)) limits.push_back(limit_json(plan, line));
  }
  Json channels = list_of(lcm_channels(plan, what.lcm), [](const LcmChannel& channel) {
    return Json{{"channel", channel.name}, {"type", channel.type}};
  });
  print_document(out, Json{{"bus", plan.name},
                           {"interface", plan.interface},
                           {"bitrate", plan.bitrate},
                           {"master_id", plan.master_id.value()},
                           {"master_heartbeat_us", us(plan.master_heartbeat)},
                           {"start_nodes", plan.start_nodes},
                           {"cycle", cycle_json(plan)},
                           {"waits", waits_json(plan)},
                           {"nodes", std::move(nodes)},
                           {"image",
                            {{"inputs", plan.layout.inputs},
                             {"outputs", plan.layout.outputs()},
                             {"hash", plan.layout.hash},
                             {"signals", std::move(signals)}}},
                           {"limits", std::move(limits)},
                           {"lcm", {{"url", what.lcm.url}, {"channels", std::move(channels)}}}});
}

}  // namespace takt
