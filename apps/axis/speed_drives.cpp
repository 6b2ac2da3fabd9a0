#include "apps/axis/speed_drives.hpp"

#include <algorithm>
#include <fmt/format.h>

#include "apps/axis/not_ready.hpp"
#include "master/lcm/printable_text.hpp"

namespace takt {

void SpeedDrives::set_goal(SpeedGoal goal) {
  for (SpeedAxis& axis : axes_) axis.set_goal(goal);
}

void SpeedDrives::stop() {
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    if (axes_[i].goal() == SpeedGoal::off) continue;
    axes_[i].set_goal(SpeedGoal::standing, 0.0,
                      i < accelerations_.size() ? accelerations_[i] : 0.0);
  }
}

void SpeedDrives::end_run() {
  for (SpeedAxis& axis : axes_) {
    if (axis.goal() == SpeedGoal::running) axis.set_goal(SpeedGoal::standing);
  }
}

void SpeedDrives::run(const Eigen::Ref<const Eigen::VectorXd>& speeds,
                      const Eigen::VectorXd& accelerations) {
  accelerations_.assign(axes_.size(), 0.0);
  for (Index i = 0; i < size(); ++i) {
    const double asked =
        accelerations.size() == 0 ? 0.0 : accelerations(accelerations.size() == 1 ? 0 : i);
    double& acceleration = accelerations_[static_cast<std::size_t>(i)];
    acceleration = asked > 0.0 ? asked : at(i).words().max_acceleration;
    at(i).set_goal(SpeedGoal::running, speeds(i), acceleration);
  }
}

void SpeedDrives::read(const ImageInput& input) {
  for (SpeedAxis& axis : axes_) axis.read(input);
}

void SpeedDrives::step(const ImageInput& input) {
  for (SpeedAxis& axis : axes_) axis.step(input);
}

command_t SpeedDrives::command() const {
  command_t command{};
  for (const SpeedAxis& axis : axes_) {
    if (axis.state() == SpeedState::unknown) continue;  // the commands of this axis then expire
    command.signals.push_back(axis.words().control);
    command.values.push_back(axis.control());
    command.signals.push_back(axis.words().set_speed);
    command.values.push_back(axis.set_speed());
  }
  return command;
}

bool SpeedDrives::all_ready() const {
  return std::ranges::all_of(
      axes_, [](const SpeedAxis& axis) { return axis.state() == SpeedState::ready; });
}

bool SpeedDrives::all_stand() const {
  return std::ranges::all_of(axes_, [](const SpeedAxis& axis) { return axis.stands(); });
}

bool SpeedDrives::all_run() const {
  return std::ranges::all_of(axes_, [](const SpeedAxis& axis) { return axis.runs(); });
}

bool SpeedDrives::any_in_fault() const {
  return any([](const SpeedAxis& axis) { return axis.state() == SpeedState::fault; });
}

bool SpeedDrives::any_wants_to_run() const {
  return any([](const SpeedAxis& axis) { return axis.goal() == SpeedGoal::running; });
}

bool SpeedDrives::moving() const {
  return std::ranges::any_of(axes_, [](const SpeedAxis& axis) {
    return axis.goal() == SpeedGoal::running || !axis.stands();
  });
}

bool SpeedDrives::has_node(std::int16_t node) const {
  return std::ranges::any_of(
      axes_, [node](const SpeedAxis& axis) { return axis.words().node_id == node; });
}

std::string SpeedDrives::why_not_ready(const AxisGroup& group) const {
  constexpr std::int16_t boot_ready = 2;  // node_status_t::boot_state
  std::string text;
  const auto add = [&](const std::string& line) { text += (text.empty() ? "" : "; ") + line; };
  for (const SpeedAxis& axis : axes_) {
    const std::int16_t id = axis.words().node_id;
    const std::optional<node_status_t> node = group.status_of_node(id);
    const NodeHolder& holder = group.holder_of_node(id);
    if (node && node->boot_state != boot_ready) {
      add(axis.words().node + ": its device has not booted");
    } else if (const std::string why = axis.why_not_ready(); !why.empty()) {
      const bool fault = axis.state() == SpeedState::fault;
      const std::string error = node && fault ? newest_error(*node) : "";
      add(why);
      if (!error.empty()) add(error);
    }
    if (holder.is_other()) {
      add(fmt::format("{} belongs to '{}', and the commands of this program are refused",
                      axis.words().node, printable_text(holder.name)));
    } else if (!holder.own && axis.state() == SpeedState::ready) {
      add("the daemon does not show that this program holds " + axis.words().node);
    }
  }
  return text;
}

}  // namespace takt
