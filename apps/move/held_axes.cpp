#include "apps/move/held_axes.hpp"

#include <algorithm>
#include <fmt/format.h>

#include "master/lcm/printable_text.hpp"

namespace takt {

bool holds_all(AxisGroup& group) {
  return std::ranges::all_of(numbers_of(group.axes()),
                             [&](AxisControl::Index i) { return group.holder(i).own; });
}

bool others_hold_all(AxisGroup& group, int sequence) {
  return std::ranges::all_of(numbers_of(group.axes()), [&](AxisControl::Index i) {
    return group.holder(i).is_other(sequence);
  });
}

std::string held_by_others(AxisGroup& group, int sequence) {
  std::string text;
  for (const AxisControl::Index i : numbers_of(group.axes())) {
    if (!group.holder(i).is_other(sequence)) continue;
    text += fmt::format("{}{} belongs to '{}', and the commands of this program are refused",
                        text.empty() ? "" : "; ", group.axes().name(i),
                        printable_text(group.holder(i).name));
  }
  return text;
}

void rest_where_others_hold(AxisGroup& group) {
  AxisControl& axes = group.axes();
  Eigen::VectorXd targets = axes.target_positions();
  for (const AxisControl::Index i : numbers_of(axes)) {
    if (group.holder(i).is_other()) targets(i) = axes.positions()(i);
  }
  axes.set_positions(targets);
}

}  // namespace takt
