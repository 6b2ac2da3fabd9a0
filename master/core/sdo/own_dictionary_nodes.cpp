#include <algorithm>
#include <chrono>
#include <optional>

#include "master/core/sdo/own_dictionary.hpp"
#include "master/wire/bytes.hpp"
#include "master/wire/sdo_abort.hpp"

// This file contains the objects with one sub-index for each node of the network. CiA 302-2.

namespace takt {
namespace {

using Value = OwnDictionary::Value;

constexpr std::uint8_t all_nodes = 128;  // sub-index of 0x1F82 that stands for all nodes

/// Bits of 0x1F81. CiA 302-2.
namespace assigned {
constexpr std::uint32_t is_slave = 0x01;
constexpr std::uint32_t is_booted = 0x04;
constexpr std::uint32_t is_mandatory = 0x08;
constexpr std::uint32_t is_kept_alive = 0x10;
constexpr std::uint32_t is_verified = 0x20;
constexpr std::uint32_t is_updated = 0x40;
constexpr std::uint32_t is_restored = 0x80;
}  // namespace assigned

constexpr ObjectKey software{0x1F56, 1};
constexpr std::uint16_t restore_defaults = 0x1011;

/// Value of 0x1F82: 0 means unknown, 1 missing; other values are as in the heartbeat.
std::uint8_t state_code(const NodeStatus& status) noexcept {
  if (status.boot == BootState::lost || status.boot == BootState::failed) return 1;
  switch (status.nmt) {
    case NmtState::stopped:
    case NmtState::operational:
    case NmtState::preoperational:
      return static_cast<std::uint8_t>(status.nmt);
    case NmtState::bootup:
    case NmtState::unknown:
      break;
  }
  return 0;
}

std::optional<NmtCommand> requested(std::uint8_t code) noexcept {
  switch (code) {
    case 4:
      return NmtCommand::stop;
    case 5:
      return NmtCommand::start;
    case 6:
      return NmtCommand::reset_node;
    case 7:
      return NmtCommand::reset_communication;
    case 127:
      return NmtCommand::enter_preoperational;
    default:
      return std::nullopt;
  }
}

/// Value of 0x1F8A for a node; 0 means that nothing is restored.
std::uint8_t restored_sub(const BootPlan& boot) noexcept {
  const auto restores = [](const BootStep& step) {
    return step.action == BootAction::write && step.object.index == restore_defaults;
  };
  const auto found = std::ranges::find_if(boot.steps, restores);
  return found == boot.steps.end() ? std::uint8_t{0} : found->object.sub;
}

/// The value that the boot of a node expects in an object; 0 means none.
std::uint32_t expected(const NodePlan& node, ObjectKey object) noexcept {
  for (const BootStep& step : node.boot_plan.steps) {
    const bool looks = step.action == BootAction::expect || step.action == BootAction::compare;
    if (looks && step.object == object) return load_le<std::uint32_t>(std::span{step.value});
  }
  return 0;
}

/// Value of 0x1F81 for a node.
std::uint32_t assignment_of(const NodePlan& node) noexcept {
  using namespace assigned;
  const auto has = [&](BootAction action) {
    return std::ranges::find(node.boot_plan.steps, action, &BootStep::action) !=
           node.boot_plan.steps.end();
  };
  std::uint32_t bits = is_slave;
  if (node.boot) bits |= is_booted;
  if (node.mandatory) bits |= is_mandatory;
  if (has(BootAction::await_alive)) bits |= is_kept_alive;
  if (expected(node, software) != 0) bits |= is_verified;
  if (has(BootAction::download_program)) bits |= is_updated;
  if (restored_sub(node.boot_plan) != 0) bits |= is_restored;
  const auto guard_ms =
      std::chrono::duration_cast<std::chrono::milliseconds>(node.guard.period).count();
  if (guard_ms == 0) return bits;
  const auto time = static_cast<std::uint32_t>(std::min<std::int64_t>(guard_ms, 0xFFFF));
  return bits | time << 16U | std::uint32_t{node.guard.retries} << 8U;
}

}  // namespace

bool OwnDictionary::is_of_nodes(std::uint16_t index) noexcept {
  switch (index) {
    case 0x1F26:  // configuration date
    case 0x1F27:  // configuration time
    case 0x1F55:  // software version
    case 0x1F81:  // assignment
    case 0x1F82:  // NMT state, NMT request
    case 0x1F84:  // device type
    case 0x1F85:  // vendor-ID
    case 0x1F86:  // product code
    case 0x1F87:  // revision number
    case 0x1F88:  // serial number
    case 0x1F8A:  // sub-index of 0x1011
      return true;
    default:
      return index >= 0x2100 && index <= 0x2103;
  }
}

Value OwnDictionary::read_nodes(ObjectKey key) const noexcept {
  const bool states = key.index == 0x1F82;
  if (key.sub == 0) return Value::number(states ? all_nodes : std::uint8_t{127});
  if (key.sub > 127) {
    return Value::refused(states && key.sub == all_nodes ? abort_code::write_only
                                                         : abort_code::no_sub_index);
  }
  const std::uint8_t node = position_[key.sub];
  if (states) return Value::number(node == no_node ? std::uint8_t{0} : state_code(statuses_[node]));
  if (key.index == 0x1F8A) {
    return Value::number(node == no_node ? std::uint8_t{0}
                                         : restored_sub(plan_.nodes[node].boot_plan));
  }
  return Value::number(node == no_node ? 0U : node_value(key.index, node));
}

std::uint32_t OwnDictionary::node_value(std::uint16_t index, std::size_t position) const noexcept {
  const NodePlan& node = plan_.nodes[position];
  const NodeStatus& status = statuses_[position];
  switch (index) {
    case 0x1F81:
      return assignment_of(node);
    case 0x1F26:
      return expected(node, {0x1020, 1});
    case 0x1F27:
      return expected(node, {0x1020, 2});
    case 0x1F55:
      return expected(node, software);
    case 0x1F84:
      return expected(node, {0x1000, 0});
    case 0x2100:
      return status.emcy_count;
    case 0x2101:
      return status.boot_count;
    case 0x2102:
      return status.heartbeat_lost;
    case 0x2103:
      return status.sdo_aborts;
    default:  // 0x1F85-0x1F88
      return expected(node, {0x1018, static_cast<std::uint8_t>(index - 0x1F84)});
  }
}

OwnDictionary::Order OwnDictionary::write(ObjectKey key,
                                          std::span<const std::byte> value) const noexcept {
  const auto no = [](std::uint32_t code) { return Order{.abort_code = code}; };
  if (key.index != 0x1F82 || key.sub == 0) {
    const Value present = read(key);
    return no(present.abort_code == 0 ? abort_code::read_only : present.abort_code);
  }
  if (key.sub > all_nodes) return no(abort_code::no_sub_index);
  if (value.size() > 1) return no(abort_code::length_too_high);
  if (value.empty()) return no(abort_code::length_too_low);
  const auto command = requested(std::to_integer<std::uint8_t>(value[0]));
  if (!command) return no(abort_code::invalid_value);
  if (key.sub == all_nodes) return {.command = *command, .node = 0};
  if (position_[key.sub] == no_node) return no(abort_code::cannot_store);
  return {.command = *command, .node = key.sub};
}

}  // namespace takt
