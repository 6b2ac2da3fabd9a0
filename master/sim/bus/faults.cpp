#include "master/sim/bus/faults.hpp"

#include <array>
#include <utility>

namespace takt::sim {
namespace {

constexpr std::array<std::pair<FaultKind, std::string_view>, 31> names{{
    {FaultKind::loss, "loss"},
    {FaultKind::duplicate, "duplicate"},
    {FaultKind::delay, "delay"},
    {FaultKind::error_frames, "error_frames"},
    {FaultKind::babble, "babble"},
    {FaultKind::power_off, "power_off"},
    {FaultKind::drift, "drift"},
    {FaultKind::mute_sdo, "mute_sdo"},
    {FaultKind::slow_sdo, "slow_sdo"},
    {FaultKind::refuse_object, "refuse_object"},
    {FaultKind::refuse_write, "refuse_write"},
    {FaultKind::ignore_write, "ignore_write"},
    {FaultKind::override_value, "override_value"},
    {FaultKind::late_bootup, "late_bootup"},
    {FaultKind::no_bootup, "no_bootup"},
    {FaultKind::no_heartbeat, "no_heartbeat"},
    {FaultKind::no_guarding, "no_guarding"},
    {FaultKind::stuck_toggle, "stuck_toggle"},
    {FaultKind::bootup_storm, "bootup_storm"},
    {FaultKind::self_start, "self_start"},
    {FaultKind::no_start, "no_start"},
    {FaultKind::preop_only, "preop_only"},
    {FaultKind::fixed_mapping, "fixed_mapping"},
    {FaultKind::lss_silent, "lss_silent"},
    {FaultKind::lss_no_store, "lss_no_store"},
    {FaultKind::mute_pdo, "mute_pdo"},
    {FaultKind::device_error, "device_error"},
    {FaultKind::reset, "reset"},
    {FaultKind::bus_off, "bus_off"},
    {FaultKind::stall_master, "stall_master"},
    {FaultKind::interface_down, "interface_down"},
}};

}  // namespace

std::string_view name(FaultKind kind) noexcept {
  for (const auto& [known, text] : names) {
    if (known == kind) return text;
  }
  return "unknown";
}

std::optional<FaultKind> fault_kind(std::string_view text) noexcept {
  for (const auto& [kind, known] : names) {
    if (known == text) return kind;
  }
  return std::nullopt;
}

}  // namespace takt::sim
