// The example of the README: all axes move forward slowly while images come.
#include <chrono>
#include <takt/axis.hpp>
#include <utility>

int main() {
  using namespace std::chrono_literals;
  auto lcm = takt::open_lcm("");  // LCM_DEFAULT_URL, else LCM's default
  if (!lcm) return 3;
  takt::AxisGroup group{std::move(*lcm), {.bus = "demo", .sender = "example"}};
  while (group.wait(1s) != takt::Input::restarted) {  // until the layout has come
  }
  takt::AxisControl& axes = group.axes();
  axes.set_goal(takt::DriveGoal::enabled);
  while (group.wait(1s) == takt::Input::fresh) {  // until it is stale, or none comes in 1 s
    const Eigen::VectorXd next = axes.target_positions().array() + 1e-4;  // rad
    if (axes.all_enabled()) axes.set_positions(next);
    group.send();  // acts at the next SYNC
  }
}
