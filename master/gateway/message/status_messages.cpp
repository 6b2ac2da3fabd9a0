#include "master/gateway/message/status_messages.hpp"

#include <algorithm>
#include <chrono>
#include <limits>
#include <utility>

#include "master/lcm/messages.hpp"

namespace takt {
namespace {

constexpr Time load_window = std::chrono::seconds{1};

std::int64_t missing_pdos(const BusPlan& plan, const StatusSnapshot& snapshot, std::size_t node) {
  std::int64_t missing = 0;
  for (std::size_t row = 0; row < plan.pdos.tpdos.size() && row < snapshot.tpdos.size(); ++row) {
    if (plan.pdos.tpdos[row].node_index == node) missing += snapshot.tpdos[row].missing;
  }
  return missing;
}

std::int32_t heartbeat_age(const NodeStatus& node, Time now) {
  if (node.last_heartbeat == Time{0}) return -1;
  constexpr std::chrono::milliseconds longest{std::numeric_limits<std::int32_t>::max()};
  const Time age = std::min<Time>(now - node.last_heartbeat, longest);
  return static_cast<std::int32_t>(age / std::chrono::milliseconds{1});
}

node_status_t node_message(const NodePlan& plan, const NodeStatus& status) {
  node_status_t message{};
  message.node_id = plan.id.value();
  message.name = plan.name;
  message.nmt_state = static_cast<std::int16_t>(status.nmt);
  message.boot_state = static_cast<std::int16_t>(status.boot);
  message.boot_step = static_cast<std::int16_t>(status.boot_step);
  message.boot_steps = static_cast<std::int16_t>(plan.boot_plan.steps.size());
  message.error_register = status.error_register;
  message.last_emcy = status.last_emcy;
  message.emcy_count = static_cast<std::int32_t>(status.emcy_count);
  message.boot_count = static_cast<std::int32_t>(status.boot_count);
  message.heartbeat_lost = static_cast<std::int32_t>(status.heartbeat_lost);
  message.sdo_aborts = static_cast<std::int32_t>(status.sdo_aborts);
  return message;
}

void add_emcys(const EmcyLog& log, node_status_t& message) {
  const EmcyLog::Codes& codes = log.codes(static_cast<std::uint8_t>(message.node_id));
  message.emcys.assign(codes.begin(), codes.end());
  message.num_emcys = static_cast<std::int32_t>(codes.size());
}

std::int16_t bus_state(const PortCondition& port) noexcept {
  if (port.interface_down) return 3;
  if (port.bus_off) return 2;
  return port.error_passive ? 1 : 0;
}

float microseconds(Time time) noexcept { return static_cast<float>(time.count()) / 1000.0F; }

}  // namespace

histogram_t histogram_message(std::string name, const HistogramSnapshot& times) {
  histogram_t message{};
  message.name = std::move(name);
  message.count = static_cast<std::int64_t>(times.total());
  message.minimum = microseconds(times.minimum());
  message.median = microseconds(times.percentile(0.5));
  message.p99 = microseconds(times.percentile(0.99));
  message.maximum = microseconds(times.maximum());
  for (const std::uint64_t count : times.by_octave()) {
    message.bins.push_back(static_cast<std::int64_t>(count));
  }
  while (!message.bins.empty() && message.bins.back() == 0) message.bins.pop_back();
  message.num_bins = static_cast<std::int32_t>(message.bins.size());
  return message;
}

float LoadMeter::update(Time now, std::uint64_t wire_bits) {
  samples_.push_back({.when = now, .bits = wire_bits});
  while (samples_.size() > 2 && now - samples_[1].when >= load_window) samples_.pop_front();
  const Sample& oldest = samples_.front();
  const std::chrono::duration<double> span = now - oldest.when;
  if (span.count() <= 0 || bitrate_ == 0) return 0;
  const auto bits = static_cast<double>(wire_bits - oldest.bits);
  return static_cast<float>(bits / (span.count() * bitrate_));
}

StatusMessages::StatusMessages(const BusPlan& plan, StatusIdentity identity)
    : plan_{plan}, identity_{std::move(identity)}, load_{plan.bitrate}, diagnosis_{plan} {}

status_t StatusMessages::bus_part(const StatusSnapshot& snapshot, const GatewayStatus& gateway,
                                  Time now) {
  const BusStatus& bus = snapshot.bus;
  status_t message{};
  message.schema = message_schema;
  message.session = identity_.session;
  message.bus = plan_.name;
  message.interface = identity_.interface;
  message.bitrate = static_cast<std::int32_t>(plan_.bitrate);
  message.realtime = identity_.realtime;
  message.cycle = static_cast<std::int64_t>(bus.cycle);
  message.period_ns = plan_.cycle.period.count();
  message.cycles_missed = static_cast<std::int64_t>(bus.cycles_missed);
  message.cycles_late = static_cast<std::int64_t>(bus.cycles_late);
  message.image_overruns = static_cast<std::int64_t>(gateway.image_overruns);
  message.event_overruns = static_cast<std::int64_t>(gateway.event_overruns);
  message.frames_received = static_cast<std::int64_t>(bus.frames_received);
  message.frames_sent = static_cast<std::int64_t>(bus.frames_sent);
  message.send_failures = static_cast<std::int64_t>(bus.send_failures);
  message.receive_overruns = bus.port.receive_overruns;
  message.error_frames = bus.port.error_frames;
  message.commands_taken = static_cast<std::int64_t>(gateway.commands_taken);
  message.commands_refused = static_cast<std::int64_t>(gateway.commands_refused);
  message.bus_load = load_.update(now, bus.wire_bits);
  message.bus_state = bus_state(bus.port);
  message.tx_errors = bus.port.tx_error_counter;
  message.rx_errors = bus.port.rx_error_counter;
  message.stop = static_cast<std::int16_t>(bus.stop_result);
  message.stop_text = gateway.stop_text;
  message.diagnosis = diagnosis_.fill(snapshot);
  return message;
}

std::vector<status_t> StatusMessages::fill(const StatusSnapshot& snapshot,
                                           const GatewayStatus& gateway, Time now) {
  const status_t bus = bus_part(snapshot, gateway, now);
  std::vector<status_t> messages{bus};
  for (std::size_t i = 0; i < plan_.nodes.size() && i < snapshot.nodes.size(); ++i) {
    node_status_t node = node_message(plan_.nodes[i], snapshot.nodes[i]);
    node.heartbeat_age_ms = heartbeat_age(snapshot.nodes[i], now);
    node.pdos_missing = missing_pdos(plan_, snapshot, i);
    if (i < gateway.holders.size()) node.holder = gateway.holders[i];
    if (gateway.emcys != nullptr) add_emcys(*gateway.emcys, node);
    const int size = messages.back().getEncodedSize() + node._getEncodedSizeNoHash();
    if (messages.back().num_nodes > 0 && static_cast<std::size_t>(size) > message_bytes) {
      messages.push_back(bus);
    }
    messages.back().nodes.push_back(std::move(node));
    ++messages.back().num_nodes;
  }
  number_parts(messages);
  return messages;
}

timing_t TimingMessages::fill(const TimingHistograms& timing, const Histogram& sync_to_lcm,
                              std::uint64_t cycle) {
  struct Named {
    const char* name;
    const Histogram& histogram;
  };
  const Named all[] = {{"sync_lateness", timing.sync_lateness},
                       {"sync_on_wire", timing.sync_on_wire},
                       {"sync_to_last_pdo", timing.sync_to_last_pdo},
                       {"sync_to_publish", timing.sync_to_publish},
                       {"sync_to_lcm", sync_to_lcm},
                       {"command_age", timing.command_age}};
  timing_t message{};
  message.schema = message_schema;
  message.session = session_;
  message.cycle = static_cast<std::int64_t>(cycle);
  earlier_.resize(std::size(all));
  for (std::size_t i = 0; i < std::size(all); ++i) {
    const HistogramSnapshot now = all[i].histogram.snapshot();
    message.histograms.push_back(histogram_message(all[i].name, now - earlier_[i]));
    earlier_[i] = now;
  }
  message.num_histograms = static_cast<std::int32_t>(message.histograms.size());
  return message;
}

}  // namespace takt
