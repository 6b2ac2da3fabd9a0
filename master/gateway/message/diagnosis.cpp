#include <cerrno>
#include <utility>

#include "master/gateway/message/status_messages.hpp"

namespace takt {
namespace {

constexpr std::uint8_t warning_limit = 96;  // limit of an error counter, CAN 2.0

enum class BusCondition : std::int16_t { run, starting, offline, stopped };

BusCondition condition(const BusStatus& bus) noexcept {
  if (bus.stop != StopStage::running) return BusCondition::stopped;
  if (bus.port.interface_down || bus.port.bus_off) return BusCondition::offline;
  return bus.beats == 0 ? BusCondition::starting : BusCondition::run;
}

bool is_ok(const BusPlan& plan, const NodePlan& node, const NodeStatus& status) noexcept {
  if (!node.boot) return node.heartbeat_timeout == Time{} || status.nmt != NmtState::unknown;
  if (status.boot != BootState::ready) return false;
  return !plan.start_nodes || status.nmt == NmtState::operational;
}

/// Returns a value that changes with the NMT and boot states, EMCYs and faults.
std::uint64_t digest_of(const StatusSnapshot& snapshot) noexcept {
  std::uint64_t digest = 0xCBF2'9CE4'8422'2325;  // FNV-1a, 64 bit
  const auto add = [&](std::uint64_t value) { digest = (digest ^ value) * 0x0000'0100'0000'01B3; };
  for (const NodeStatus& node : snapshot.nodes) {
    add(static_cast<std::uint64_t>(node.nmt));
    add(static_cast<std::uint64_t>(node.boot));
    add(node.emcy_count);
    add(node.heartbeat_lost);
  }
  for (const PdoStatus& pdo : snapshot.tpdos) add(pdo.stale);
  add(static_cast<std::uint64_t>(condition(snapshot.bus)));
  add(snapshot.bus.port.error_passive);
  return digest;
}

}  // namespace

diagnosis_t Diagnosis::fill(const StatusSnapshot& snapshot) {
  const BusStatus& bus = snapshot.bus;
  diagnosis_t message{};
  message.sync_count = static_cast<std::int64_t>(bus.beats);
  for (std::size_t i = 0; i < plan_.nodes.size() && i < snapshot.nodes.size(); ++i) {
    if (!is_ok(plan_, plan_.nodes[i], snapshot.nodes[i])) ++message.nodes_not_ok;
  }
  message.state = static_cast<std::int16_t>(condition(bus));
  message.bus_off = bus.port.bus_off ? 1 : 0;
  message.warning_limit = bus.port.tx_error_counter >= warning_limit ||
                          bus.port.rx_error_counter >= warning_limit || bus.port.error_passive;
  message.rx_queue_exceeded =
      std::exchange(receive_overruns_, bus.port.receive_overruns) != bus.port.receive_overruns;
  const bool not_sent = std::exchange(send_failures_, bus.send_failures) != bus.send_failures;
  message.tx_queue_exceeded = not_sent && bus.port.last_error == ENOBUFS;
  message.send_error = not_sent && bus.port.last_error != ENOBUFS;
  message.sync_toggle = static_cast<std::int8_t>(bus.beats & 1);
  message.cycles_missed = static_cast<std::int64_t>(bus.cycles_missed);
  message.outputs_skipped = static_cast<std::int64_t>(bus.outputs_skipped);
  message.images_incomplete = static_cast<std::int64_t>(bus.images_incomplete);
  message.cycles_failed =
      message.cycles_missed + message.outputs_skipped + message.images_incomplete;
  const std::uint64_t digest = digest_of(snapshot);
  message.changed = std::exchange(digest_, digest) != digest;
  return message;
}

}  // namespace takt
