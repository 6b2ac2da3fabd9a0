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
  // If PDOs carry only one of the two modes, this mode counts for both.
  const auto displayed =
      limit.mode_display ? std::optional{image_.values[*limit.mode_display]} : std::nullopt;
  const auto ordered = limit.mode ? std::optional{mode} : displayed ? displayed : limit.fixed_mode;
  if (!ordered) return {.commanded = true, .shown = true};
  const std::int64_t shown = displayed.value_or(*ordered);
  return {.commanded = follows(limit.quantity, *ordered),
          .shown = follows(limit.quantity, shown),
          .ramps = has_ramps(limit.quantity, *ordered) && has_ramps(limit.quantity, shown)};
}

/// Returns true if steps between successive values of this output are checked. Steps of a position
/// are checked in the modes in which the drive follows each value. Steps of target velocities and
/// torques are checked in every mode, because the drive may follow them after a change of the mode.
/// The exception is a velocity that the drive reaches along its own ramps.
bool OutputLimits::follows_each(std::size_t place, ModesFollowed modes) const noexcept {
  if (limits_[place].quantity == AxisQuantity::position) return modes.any();
  return !modes.ramps;
}

/// Returns true if the next step begins at the value that was sent last, and not at the actual
/// value. The value that was sent last does not count if the drive did not have to follow it at
/// once.
bool OutputLimits::starts_from_last(std::size_t place, ModesFollowed modes) const noexcept {
  const Slot& slot = slots_[place];
  if (!slot.known) return false;
  if (!slot.idle || !follows_each(place, modes)) return true;
  // Without an actual velocity, the value that was sent last is the best that is known.
  return limits_[place].quantity == AxisQuantity::velocity && !actual(place);
}

bool OutputLimits::covered_by_target(std::size_t place, std::int64_t mode) const noexcept {
  return limits_[place].target && modes_followed(place, mode).both();
}

}  // namespace takt
