#include "master/motion/beat/stop_profile.hpp"

#include "master/motion/axis_motion.hpp"
#include "master/motion/beat/profile_player.hpp"

namespace takt::motion {

Profile stop_profile(const State& from, const Limits& limits) noexcept {
  const AxisMotion motion{from, State{}, limits, Goal::velocity};
  return motion.profile(motion.possible(0.0));
}

std::optional<Cycle> cycles_with_stop(const MotionOrder& order, const PositionRange& range,
                                      double period, Cycle limit) noexcept {
  ProfilePlayer player{order.profile, order.from, order.ending};
  std::optional<Cycle> last;
  for (Cycle cycle = 0; cycle <= limit; ++cycle) {
    const State state = player.at(static_cast<double>(cycle) * period);
    if (!stays_inside(range, stop_profile(state, order.stop), state)) break;
    last = cycle;
  }
  return last;
}

}  // namespace takt::motion
