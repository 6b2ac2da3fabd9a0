#include "eds_parser/table/axis_modes.hpp"
#include "master/core/pdo/output_limits.hpp"

namespace takt {
namespace {

// Values of the statusword, CiA 402-2, table of states.
constexpr std::int64_t state_bits = 0x6F;
constexpr std::int64_t operation_enabled = 0x27;
constexpr std::int64_t short_state_bits = 0x4F;
constexpr std::int64_t fault_reaction_active = 0x0F;
constexpr std::int64_t fault = 0x08;
constexpr std::int64_t switch_on_disabled = 0x40;

/// Returns true in the states in which drives ignore a controlword that stays at "enable
/// operation".
bool ignores_enabling(std::int64_t statusword) noexcept {
  const std::int64_t state = statusword & short_state_bits;
  return state == fault_reaction_active || state == fault || state == switch_on_disabled;
}

}  // namespace

/// Returns true if the axis is enabled. Without a statusword, it counts as enabled if the
/// controlword that was sent last enables it.
bool OutputLimits::enabled(std::size_t place) const noexcept {
  const auto statusword = limits_[place].statusword;
  if (statusword && inputs_.fresh(*statusword)) {
    return (image_.values[*statusword] & state_bits) == operation_enabled;
  }
  return !limits_[place].controlword || enables(slots_[place].order);
}

/// Returns true if the axis is not enabled, so that it would start from its actual position, and
/// this position is known. The result is false for a drive that has left Operation enabled by
/// itself while its application still commands a motion: it can't be enabled without another
/// controlword, and its set-points may continue until then.
bool OutputLimits::starts_from_actual(std::size_t place, std::int64_t order) const noexcept {
  if (enabled(place) || !actual(place)) return false;
  const auto statusword = limits_[place].statusword;
  const bool was_enabled = enables(order) && enables(slots_[place].order);
  return !was_enabled || !statusword || !inputs_.fresh(*statusword) ||
         !ignores_enabling(image_.values[*statusword]);
}

bool OutputLimits::begins(std::size_t place, std::int64_t order) const noexcept {
  if (const auto& orders = limits_[place].orders) {
    const double factor = orders->factor(order);
    return factor != 0.0 && factor != orders->factor(slots_[place].order);
  }
  return limits_[place].controlword && enables(order) && !enabled(place);
}

OutputLimits::ModesFollowed OutputLimits::modes_followed(std::size_t place,
                                                         std::int64_t mode) const noexcept {
  const OutputLimit& limit = limits_[place];
  const bool commanded = limit.mode ? follows(limit.quantity, mode) : !limit.idle;
  if (!limit.mode_display) return {.commanded = commanded, .shown = commanded};
  const bool shown = follows(limit.quantity, image_.values[*limit.mode_display]);
  return {.commanded = limit.mode ? commanded : shown, .shown = shown};
}

bool OutputLimits::covered_by_target(std::size_t place, std::int64_t mode) const noexcept {
  return limits_[place].target && modes_followed(place, mode).both();
}

}  // namespace takt
