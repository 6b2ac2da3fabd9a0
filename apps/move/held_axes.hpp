#pragma once
#include <ranges>
#include <string>
#include <takt/axis.hpp>

namespace takt {

/// Returns the numbers of all axes.
inline auto numbers_of(const AxisControl& axes) {
  return std::views::iota(AxisControl::Index{0}, axes.size());
}

/// Returns true if the newest status_t shows that this program holds the nodes of all axes.
bool holds_all(AxisGroup& group);
/// Returns true if at least the newest `sequence` status_t show that another program holds the
/// nodes of all axes.
bool others_hold_all(AxisGroup& group, int sequence);
/// Returns a sentence for each axis whose node is held by another program according to each of the
/// newest `sequence` messages status_t. The text is empty if there is no such axis.
std::string held_by_others(AxisGroup& group, int sequence);

/// Sets the target of each axis that another program holds to its actual position, so that the axis
/// does not jump if this program holds it afterwards.
void rest_where_others_hold(AxisGroup& group);

}  // namespace takt
