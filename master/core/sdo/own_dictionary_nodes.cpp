#include <algorithm>
#include <chrono>
#include <iterator>
#include <utility>

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

constexpr std::uint16_t node_states = 0x1F82;  // NMT state, NMT request
constexpr ObjectKey software{0x1F56, 1};
constexpr std::uint16_t restore_defaults = 0x1011;

/// Returns the value of 0x1F82: 0 means unknown, 1 missing; other values are as in the heartbeat.
std::uint32_t state_of(const NodePlan&, const NodeStatus& status) noexcept {
  if (status.boot == BootState::lost || status.boot == BootState::failed) return 1;
  return status.nmt == NmtState::unknown ? 0U : std::to_underlying(status.nmt);
}

struct NmtRequest {
  std::uint8_t code;
  NmtCommand command;
};

constexpr NmtRequest nmt_requests[] = {{4, NmtCommand::stop},
                                       {5, NmtCommand::start},
                                       {6, NmtCommand::reset_node},
                                       {7, NmtCommand::reset_communication},
                                       {127, NmtCommand::enter_preoperational}};

/// Returns the value of 0x1F8A for a node; 0 means that nothing is restored.
std::uint32_t restored_sub(const NodePlan& node, const NodeStatus&) noexcept {
  const auto restores = [](const BootStep& step) {
    return step.action == BootAction::write && step.object.index == restore_defaults;
  };
  const auto found = std::ranges::find_if(node.boot_plan.steps, restores);
  return found == node.boot_plan.steps.end() ? 0U : found->object.sub;
}

/// Returns the value that the boot of a node expects in an object; 0 means none.
std::uint32_t expected(const NodePlan& node, ObjectKey object) noexcept {
  for (const BootStep& step : node.boot_plan.steps) {
    const bool looks = step.action == BootAction::expect || step.action == BootAction::compare;
    if (looks && step.object == object) return load_le<std::uint32_t>(std::span{step.value});
  }
  return 0;
}

/// Returns the value of 0x1F81 for a node.
std::uint32_t assignment_of(const NodePlan& node, const NodeStatus& status) noexcept {
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
  if (restored_sub(node, status) != 0) bits |= is_restored;
  const auto guard_ms =
      std::chrono::duration_cast<std::chrono::milliseconds>(node.guard.period).count();
  if (guard_ms == 0) return bits;
  const auto time = static_cast<std::uint32_t>(std::min<std::int64_t>(guard_ms, 0xFFFF));
  return bits | time << 16U | std::uint32_t{node.guard.retries} << 8U;
}

template <std::uint16_t index, std::uint8_t sub>
std::uint32_t expected_in(const NodePlan& node, const NodeStatus&) noexcept {
  return expected(node, {index, sub});
}

template <std::uint32_t NodeStatus::* count>
std::uint32_t counted(const NodePlan&, const NodeStatus& status) noexcept {
  return status.*count;
}

/// An object with one sub-index for each node.
struct NodeObject {
  std::uint16_t index;
  std::uint32_t (*value)(const NodePlan& node, const NodeStatus& status) noexcept;
  std::uint8_t bytes = 4;  // size of a value, 1 or 4
};

constexpr NodeObject node_objects[] = {
    {0x1F26, expected_in<0x1020, 1>},                     // configuration date
    {0x1F27, expected_in<0x1020, 2>},                     // configuration time
    {0x1F55, expected_in<software.index, software.sub>},  // software version
    {0x1F81, assignment_of},
    {node_states, state_of, 1},
    {0x1F84, expected_in<0x1000, 0>},  // device type
    {0x1F85, expected_in<0x1018, 1>},  // vendor-ID
    {0x1F86, expected_in<0x1018, 2>},  // product code
    {0x1F87, expected_in<0x1018, 3>},  // revision number
    {0x1F88, expected_in<0x1018, 4>},  // serial number
    {0x1F8A, restored_sub, 1},
    {0x2100, counted<&NodeStatus::emcy_count>},
    {0x2101, counted<&NodeStatus::boot_count>},
    {0x2102, counted<&NodeStatus::heartbeat_lost>},
    {0x2103, counted<&NodeStatus::sdo_aborts>}};

}  // namespace

bool OwnDictionary::is_of_nodes(std::uint16_t index) noexcept {
  return std::ranges::find(node_objects, index, &NodeObject::index) != std::end(node_objects);
}

Value OwnDictionary::read_nodes(ObjectKey key) const noexcept {
  const bool states = key.index == node_states;
  if (key.sub == 0) return Value::number(states ? all_nodes : std::uint8_t{127});
  if (key.sub > 127) {
    return Value::refused(states && key.sub == all_nodes ? abort_code::write_only
                                                         : abort_code::no_sub_index);
  }
  const auto* const object = std::ranges::find(node_objects, key.index, &NodeObject::index);
  const std::uint8_t node = position_[key.sub];
  const std::uint32_t value =
      node == no_node ? 0U : object->value(plan_.nodes[node], statuses_[node]);
  return object->bytes == 1 ? Value::number(static_cast<std::uint8_t>(value))
                            : Value::number(value);
}

OwnDictionary::Order OwnDictionary::write(ObjectKey key,
                                          std::span<const std::byte> value) const noexcept {
  const auto no = [](std::uint32_t code) { return Order{.abort_code = code}; };
  if (key.index != node_states || key.sub == 0) {
    const Value present = read(key);
    return no(present.abort_code == 0 ? abort_code::read_only : present.abort_code);
  }
  if (key.sub > all_nodes) return no(abort_code::no_sub_index);
  if (value.size() > 1) return no(abort_code::length_too_high);
  if (value.empty()) return no(abort_code::length_too_low);
  const auto* const request =
      std::ranges::find(nmt_requests, std::to_integer<std::uint8_t>(value[0]), &NmtRequest::code);
  if (request == std::end(nmt_requests)) return no(abort_code::invalid_value);
  if (key.sub == all_nodes) return {.command = request->command, .node = 0};
  if (position_[key.sub] == no_node) return no(abort_code::cannot_store);
  return {.command = request->command, .node = key.sub};
}

}  // namespace takt
