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

using Milliseconds = std::chrono::milliseconds;
using Microseconds = std::chrono::microseconds;
using HundredMicroseconds = std::chrono::duration<std::int64_t, std::ratio<1, 10'000>>;

/// Returns a time as a number of units.
template <class T, class Unit>
Value count_of(Time time) noexcept {
  return Value::number(static_cast<T>(std::chrono::duration_cast<Unit>(time).count()));
}

/// Returns the value of 0x1F80.
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
  if (key.index == 0x1016) return read_consumers(key.sub);
  if (key.index == 0x1018) {  // takt has no vendor-ID from CAN in Automation.
    if (key.sub > 4) return Value::refused(abort_code::no_sub_index);
    return key.sub == 0 ? Value::number(std::uint8_t{4}) : Value::number(std::uint32_t{0});
  }
  if (key.index == 0x1200) {
    if (key.sub > 2) return Value::refused(abort_code::no_sub_index);
    if (key.sub == 0) return Value::number(std::uint8_t{2});
    return Value::number(std::uint32_t{(key.sub == 1 ? 0x600U : 0x580U) + plan_.master_id.value()});
  }
  const Value value = read_variable(key.index);
  const bool known = value.abort_code == 0;
  return known && key.sub != 0 ? Value::refused(abort_code::no_sub_index) : value;
}

/// Returns the value of an object that has only sub-index 0.
Value OwnDictionary::read_variable(std::uint16_t index) const noexcept {
  const CyclePlan& cycle = plan_.cycle;
  switch (index) {
    case 0x1000:
      return Value::number(std::uint32_t{0});
    case 0x1001:
      return Value::number(std::uint8_t{0});
    case 0x1005:
      return Value::number(cycle.sync_cob_id.id() | (cycle.makes_sync() ? makes_sync : 0U));
    case 0x1006:
      return count_of<std::uint32_t, Microseconds>(cycle.sync ? cycle.period : Time{});
    case 0x1008:
      return text(device_name);
    case 0x100A:
      return text(TAKT_VERSION);
    case 0x1012:
      return Value::number(plan_.time.cob_id.id() | (plan_.time.period > Time{} ? makes_time : 0U));
    case 0x1017:
      return count_of<std::uint16_t, Milliseconds>(plan_.master_heartbeat);
    case 0x1019:
      return Value::number(cycle.sync_overflow);
    case 0x102A:
      return count_of<std::uint16_t, HundredMicroseconds>(plan_.start_up.nmt_inhibit);
    case 0x1F80:
      return Value::number(start_up_of(plan_));
    case 0x1F89:
      return count_of<std::uint32_t, Milliseconds>(plan_.start_up.boot_time);
    default:
      return Value::refused(abort_code::no_object);
  }
}

/// Returns the value of 0x1016: the heartbeat consumers, in the order of the nodes.
Value OwnDictionary::read_consumers(std::uint8_t sub) const noexcept {
  const std::size_t count = plan_.nodes.size();
  if (sub == 0) return Value::number(static_cast<std::uint8_t>(count));
  if (sub > count) return Value::refused(abort_code::no_sub_index);
  const NodePlan& node = plan_.nodes[sub - 1U];
  const auto ms = std::chrono::duration_cast<Milliseconds>(node.heartbeat_timeout).count();
  const auto time = static_cast<std::uint32_t>(std::min<std::int64_t>(ms, 0xFFFF));
  return Value::number(time == 0 ? 0U : std::uint32_t{node.id.value()} << 16 | time);
}

}  // namespace takt
