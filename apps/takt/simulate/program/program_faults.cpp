#include "apps/takt/simulate/program/program_faults.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace takt {
namespace {

constexpr std::array<std::string_view, 12> names{
    "stall_front",      "kill_master",     "stall_application", "slow_application",
    "kill_application", "end_application", "second_sender",     "slow_messages",
    "replay",           "forge_command",   "forge_image",       "damage_messages"};

}  // namespace

std::string_view name(ProgramFaultKind kind) noexcept { return names[std::to_underlying(kind)]; }

std::optional<ProgramFaultKind> program_fault_kind(std::string_view name) noexcept {
  const auto found = std::ranges::find(names, name);
  if (found == names.end()) return std::nullopt;
  return static_cast<ProgramFaultKind>(found - names.begin());
}

std::vector<std::string_view> program_fault_names() { return {names.begin(), names.end()}; }

bool concerns_application(ProgramFaultKind kind) noexcept {
  return kind >= ProgramFaultKind::stall_application && kind <= ProgramFaultKind::second_sender;
}

}  // namespace takt
