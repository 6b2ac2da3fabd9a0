#include <charconv>
#include <fmt/format.h>

#include "apps/axis/axes_state.hpp"

namespace takt {
namespace {

/// Value of axis_motion_t::gear.
constexpr std::int8_t gear_locked = 2;

/// Fills in one number for each axis: the number for this axis, the number for all axes, or
/// `otherwise`. Returns false if the number of values does not fit.
bool spread(const Eigen::VectorXd& values, Eigen::Index axes, double otherwise,
            std::vector<double>& found) {
  if (values.size() > 1 && values.size() != axes) return false;
  for (Eigen::Index i = 0; i < axes; ++i) {
    const bool given = values.size() != 0;
    found.push_back(given ? values(values.size() == 1 ? 0 : i) : otherwise);
  }
  return true;
}

/// Splits "gantry.2" into its node and the number of its axis.
void name_axis(const std::string& name, motion_gear_t& message) {
  message.leader = name;
  const std::size_t dot = name.rfind('.');
  if (dot == std::string::npos) return;
  int number = 0;
  const char* end = name.data() + name.size();
  const auto read = std::from_chars(name.data() + dot + 1, end, number);
  if (read.ec != std::errc{} || read.ptr != end || number < 1 || number > 8) return;
  message.leader = name.substr(0, dot);
  message.leader_axis = static_cast<std::int8_t>(number);
}

}  // namespace

Done Axes::State::gear(const Gear& gear, const MotionBounds& bounds) {
  motion_gear_t message{};
  std::vector<double> phases;
  if (!spread(gear.ratio, size(), 1.0, message.numerator) ||
      !spread(gear.max_phase_error, size(), 0.0, message.max_phase_error) ||
      !spread(gear.phase, size(), 0.0, phases)) {
    return obstacle(
        Obstacle::Kind::wrong_use,
        fmt::format(
            "the ratio, the phase and the largest phase error of a gear need one value for each "
            "of {} axes, or one for all",
            size()));
  }
  if (Done ready = wait_for_begin(bounds); !ready) return ready;
  if (gear.signal.empty()) {
    name_axis(gear.leader, message);
  } else {
    message.leader = gear.leader;
  }
  message.signal = gear.signal;
  message.modulo = gear.modulo;
  message.filter_time = std::chrono::duration<double>{gear.filter_time}.count();
  message.phase = gear.phase.size() == 0 ? "here" : "at";
  message.denominator.assign(message.numerator.size(), 1.0);
  message.timeout_ms = static_cast<std::int32_t>(options.timeout.count());
  message.goals = goals_within(bounds);
  for (std::size_t i = 0; i < phases.size(); ++i) message.goals[i].position = phases[i];
  message.id = note_begin();
  if (!group.send_gear(message)) {
    return obstacle(Obstacle::Kind::no_bus, "LCM did not accept the command");
  }
  return wait_for_answer();
}

bool Axes::State::locked() const {
  return all([this](Index axis) {
    const auto motion = group.motion(axis);
    return motion && motion->id == id_ && motion->gear == gear_locked;
  });
}

Done Axes::State::wait_locked(std::chrono::nanoseconds longest) {
  const auto over = [this] { return locked() || course() != Course::runs; };
  const auto waited = wait_until(over, longest);
  if (!waited) {
    return obstacle(Obstacle::Kind::time_over,
                    "the axes have not reached the state of their leader");
  }
  if (!*waited || locked()) return *waited;
  return ended();
}

}  // namespace takt
