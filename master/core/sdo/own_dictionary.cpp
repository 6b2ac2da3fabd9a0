#include "master/core/sdo/own_dictionary.hpp"

#include <algorithm>
#include <chrono>
#include <string_view>

#include "master/wire/sdo_abort.hpp"

namespace takt {
namespace {

using Value = OwnDictionary::Value;

constexpr std::string_view device_name = "takt CANopen master";
constexpr std::uint32_t makes_sync = 0x4000'0000;
constexpr std::uint32_t makes_time = 0x4000'0000;

/// Bits of 0x1F80. CiA 302-2.
namespace start_up {
constexpr std::uint32_t is_master = 0x01;
constexpr std::uint32_t starts_all_at_once = 0x02;
constexpr std::uint32_t stays_preoperational = 0x04;
constexpr std::uint32_t starts_nobody = 0x08;
constexpr std::uint32_t resets_all = 0x10;
constexpr std::uint32_t stops_all = 0x40;
}  // namespace start_up

Value text(std::string_view text) noexcept {
  Value out{.size = static_cast<std::uint8_t>(std::min(text.size(), OwnDictionary::longest))};
  for (std::size_t i = 0; i < out.size; ++i) out.bytes[i] = static_cast<std::byte>(text[i]);
  return out;
}

template <class Unit>
std::uint64_t count_of(Time time) noexcept {
  return static_cast<std::uint64_t>(std::chrono::duration_cast<Unit>(time).count());
}

/// Value of 0x1F80.
std::uint32_t start_up_of(const BusPlan& plan) noexcept {
  using namespace start_up;
  std::uint32_t bits = is_master;
  if (plan.start_up.start_all) bits |= starts_all_at_once;
  if (!plan.start_up.start_master) bits |= stays_preoperational;
  if (!plan.start_nodes) bits |= starts_nobody;
  if (plan.start_up.on_loss == MandatoryLoss::reset_all) bits |= resets_all;
  if (plan.start_up.on_loss == MandatoryLoss::stop_all) bits |= stops_all;
  return bits;
}

}  // namespace

OwnDictionary::OwnDictionary(const BusPlan& plan, std::span<const NodeStatus> statuses) noexcept
    : plan_{plan}, statuses_{statuses} {
  position_.fill(no_node);
  for (std::size_t i = 0; i < plan.nodes.size(); ++i) {
    position_[plan.nodes[i].id.value()] = static_cast<std::uint8_t>(i);
  }
}

Value OwnDictionary::read(ObjectKey key) const noexcept {
  if (is_of_nodes(key.index)) return read_nodes(key);
  return read_communication(key);
}

Value OwnDictionary::read_communication(ObjectKey key) const noexcept {
  const CyclePlan& cycle = plan_.cycle;
  if (key.index == 0x1016) return read_consumers(key.sub);
  if (key.index == 0x1018) {  // takt has no vendor-ID of CAN in Automation
    if (key.sub > 4) return Value::refused(abort_code::no_sub_index);
    return key.sub == 0 ? Value::number(std::uint8_t{4}) : Value::number(std::uint32_t{0});
  }
  if (key.index == 0x1200) {
    if (key.sub > 2) return Value::refused(abort_code::no_sub_index);
    if (key.sub == 0) return Value::number(std::uint8_t{2});
    return Value::number(std::uint32_t{(key.sub == 1 ? 0x600U : 0x580U) + plan_.master_id.value()});
  }
  Value value = Value::refused(abort_code::no_object);
  switch (key.index) {
    case 0x1000:
      value = Value::number(std::uint32_t{0});
      break;
    case 0x1001:
      value = Value::number(std::uint8_t{0});
      break;
    case 0x1005:
      value = Value::number(cycle.sync_cob_id.id() | (cycle.makes_sync() ? makes_sync : 0U));
      break;
    case 0x1006:
      value = Value::number(static_cast<std::uint32_t>(
          cycle.sync ? count_of<std::chrono::microseconds>(cycle.period) : 0U));
      break;
    case 0x1008:
      value = text(device_name);
      break;
    case 0x100A:
      value = text(TAKT_VERSION);
      break;
    case 0x1012:
      value =
          Value::number(plan_.time.cob_id.id() | (plan_.time.period > Time{} ? makes_time : 0U));
      break;
    case 0x1017:
      value = Value::number(
          static_cast<std::uint16_t>(count_of<std::chrono::milliseconds>(plan_.master_heartbeat)));
      break;
    case 0x1019:
      value = Value::number(cycle.sync_overflow);
      break;
    case 0x102A:
      value = Value::number(static_cast<std::uint16_t>(
          count_of<std::chrono::microseconds>(plan_.start_up.nmt_inhibit) / 100));
      break;
    case 0x1F80:
      value = Value::number(start_up_of(plan_));
      break;
    case 0x1F89:
      value = Value::number(static_cast<std::uint32_t>(
          count_of<std::chrono::milliseconds>(plan_.start_up.boot_time)));
      break;
    default:
      break;
  }
  const bool known = value.abort_code == 0;
  return known && key.sub != 0 ? Value::refused(abort_code::no_sub_index) : value;
}

/// Value of 0x1016: the heartbeat consumers, in the order of the nodes.
Value OwnDictionary::read_consumers(std::uint8_t sub) const noexcept {
  const std::size_t count = plan_.nodes.size();
  if (sub == 0) return Value::number(static_cast<std::uint8_t>(count));
  if (sub > count) return Value::refused(abort_code::no_sub_index);
  const NodePlan& node = plan_.nodes[sub - 1U];
  const std::uint64_t ms =
      std::min<std::uint64_t>(count_of<std::chrono::milliseconds>(node.heartbeat_timeout), 0xFFFF);
  return Value::number(
      static_cast<std::uint32_t>(ms == 0 ? 0U : std::uint32_t{node.id.value()} << 16 | ms));
}

}  // namespace takt
