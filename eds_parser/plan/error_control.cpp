#include "eds_parser/plan/error_control.hpp"

#include <algorithm>
#include <cmath>

#include "eds_parser/dictionary/integer_of.hpp"
#include "eds_parser/plan/boot/boot_compiler.hpp"
#include "eds_parser/plan/frame_time.hpp"
#include "eds_parser/specification/device_data.hpp"

namespace takt {
namespace {

constexpr std::uint16_t default_producer_ms = 100;

}  // namespace

double ErrorControl::multiplier(const NodeSpec& node) const {
  const double given =
      node.heartbeat_multiplier.given
          ? *node.heartbeat_multiplier
          : spec_.master.heartbeat_multiplier.value_or(*spec_.heartbeat_multiplier);
  return std::max(1.5, given);
}

std::uint16_t ErrorControl::producer_ms(const NodeSource& node) const {
  const std::uint16_t ms = wanted_producer_ms(node);
  return node.data == nullptr ? ms : static_cast<std::uint16_t>(node.data->heartbeat.kept(ms));
}

std::uint16_t ErrorControl::master_consumer_ms(const NodeSource& node) const {
  const double accepted = *spec_.master.heartbeat_producer * multiplier(*node.spec);
  const auto ms = static_cast<std::uint32_t>(std::min(65535.0, std::ceil(accepted)));
  if (node.data == nullptr) return static_cast<std::uint16_t>(ms);
  const HeartbeatRule& rule = node.data->heartbeat;
  const std::uint32_t rounded_up = rule.kept(ms + rule.multiple_of_ms - 1U);
  return static_cast<std::uint16_t>(rounded_up > 65535 ? rule.kept(ms) : rounded_up);
}

std::uint16_t ErrorControl::wanted_producer_ms(const NodeSource& node) const {
  if (node.spec->heartbeat_producer.given) return *node.spec->heartbeat_producer;
  const std::int64_t own = integer_of(*node.dictionary, {0x1017, 0}).value_or(0);
  if (own > 0 && own <= 0xFFFF) return static_cast<std::uint16_t>(own);
  if (!has_heartbeat_producer(*node.dictionary) || !*node.spec->boot) return 0;
  const Time all =
      wire_time(worst_frame_bits(1) * spec_.nodes.size(), *spec_.master.baudrate_kbit * 1000);
  const auto floor = static_cast<std::uint32_t>(all * 50 / std::chrono::milliseconds{1}) + 1;
  return static_cast<std::uint16_t>(
      std::clamp<std::uint32_t>((floor + 49) / 50 * 50, default_producer_ms, 60'000));
}

Time ErrorControl::heartbeat_timeout(const NodeSource& node) const {
  if (!*spec_.master.heartbeat_consumer) return Time{};
  const double ms = producer_ms(node) * multiplier(*node.spec);
  return Time{static_cast<Time::rep>(std::llround(ms * 1e6))};
}

GuardPlan ErrorControl::guard(const NodeSource& node) {
  const NodeSpec& spec = *node.spec;
  const std::int64_t own = integer_of(*node.dictionary, {0x100C, 0}).value_or(0);
  const std::int64_t ms = spec.guard_time.given ? *spec.guard_time : own;
  const std::int64_t factor = integer_of(*node.dictionary, {0x100D, 0}).value_or(0);
  const auto of_device = static_cast<std::uint8_t>(
      factor > 0 && factor <= 255 ? factor : std::int64_t{*spec_.retry_factor});
  const std::uint8_t retries =
      spec.retry_factor.value_or(spec_.retry_factor.given ? *spec_.retry_factor : of_device);
  const std::string name = "node `" + spec.name + "` ";
  if (!*spec.boot) {
    leave_alone(spec, name + "is only watched (`boot: false`)");
  } else if (!*spec_.master.heartbeat_consumer) {
    leave_alone(spec, name + "is not watched (`heartbeat_consumer: false` of `master`)");
  } else if (producer_ms(node) != 0) {
    leave_alone(
        spec,
        name + "has a heartbeat, and with a heartbeat a node does not answer guarding (CiA 301)",
        "; `heartbeat_producer: 0` would switch to guarding");
  } else if (ms <= 0 || ms > 0xFFFF) {
    leave_alone(spec, name + "has no guard time, neither in the network file nor in " +
                          node.dictionary->file);
  } else if (retries == 0) {  // CiA 302-2, 0x1F81: a factor of 0 switches guarding off.
    leave_alone(spec, name + "is not guarded (`retry_factor: 0`)");
    return {.period = Time{}, .retries = 0};
  } else {
    guards_ = true;
    uses_retry_factor_ = uses_retry_factor_ || !spec.retry_factor.given;
    return {.period = std::chrono::milliseconds{ms}, .retries = retries};
  }
  return {};
}

void ErrorControl::report_unused_retry_factor() const {
  if (!spec_.retry_factor.given || *spec_.retry_factor == 0 || uses_retry_factor_) return;
  report_.note(spec_.retry_factor.pos, "guarding", "`retry_factor` of `options` has no effect: ",
               guards_ ? "each guarded node has its own `retry_factor`" : "no node is guarded");
}

/// Notes the guarding settings that have no effect because the node is not guarded. A setting of 0
/// asks for no guarding and is not reported.
void ErrorControl::leave_alone(const NodeSpec& spec, const std::string& why,
                               const std::string& remedy) const {
  const auto announce = [&](const auto& key, const std::string& word) {
    if (!key.given || *key == 0) return;
    report_.note(key.pos, "guarding", why, ": `", word, "` has no effect", remedy);
  };
  announce(spec.guard_time, "guard_time");
  announce(spec.life_time_factor, "life_time_factor");
  announce(spec.retry_factor, "retry_factor");
}

void check_keep_alive(const NodeSpec& spec, const NodePlan& node, NetworkReport& report) {
  const bool shows_life = node.heartbeat_timeout != Time{} || node.guard.period != Time{};
  if (*spec.reset != ResetPolicy::keep_alive || !node.boot || shows_life) return;
  report.error(spec.reset.pos, "keep-alive", "node `", spec.name,
               "` is kept running (`reset: keep_alive`), but shows its state neither by heartbeat "
               "nor by guarding: "
               "write `heartbeat_producer`, `guard_time` or `reset: none`");
}

}  // namespace takt
