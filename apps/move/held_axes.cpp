#include "apps/move/held_axes.hpp"

#include <fmt/format.h>

#include "master/lcm/printable_text.hpp"

namespace takt {

bool holds_all(AxisGroup& group) {
  for (AxisControl::Index i = 0; i < group.axes().size(); ++i) {
    if (!group.holder(i).own) return false;
  }
  return true;
}

bool others_hold_all(AxisGroup& group, int sequence) {
  for (AxisControl::Index i = 0; i < group.axes().size(); ++i) {
    if (!group.holder(i).is_other(sequence)) return false;
  }
  return true;
}

std::string held_by_others(AxisGroup& group, int sequence) {
  std::string text;
  for (AxisControl::Index i = 0; i < group.axes().size(); ++i) {
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
  for (AxisControl::Index i = 0; i < axes.size(); ++i) {
    if (group.holder(i).is_other()) targets(i) = axes.positions()(i);
  }
  axes.set_positions(targets);
}

}  // namespace takt
