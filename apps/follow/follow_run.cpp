#include "apps/follow/follow_run.hpp"

#include <chrono>
#include <cstdio>
#include <fmt/format.h>

#include "master/lcm/printable_text.hpp"

namespace takt {
namespace {

/// Time between two updates of the line on the terminal.
constexpr std::chrono::milliseconds look{100};

Eigen::VectorXd one(double value) { return Eigen::VectorXd::Constant(1, value); }

}  // namespace

Done FollowRun::run() {
  if (Done enabled = axes_.enable(); !enabled) return enabled;
  Done followed = follow();
  if (followed) followed = axes_.stop();
  const Done disabled = axes_.disable();
  show("is disabled");
  std::puts("");
  const bool asked = !followed && followed.error().kind == Obstacle::Kind::interrupted;
  return followed || asked ? disabled : followed;
}

/// Follows the leader until the time is over. Only the time in which the axis is locked to its
/// leader counts.
Done FollowRun::follow() {
  Gear gear{.leader = options_.leader,
            .signal = options_.signal,
            .ratio = one(options_.ratio),
            .modulo = options_.modulo,
            .filter_time = options_.filter_time,
            .max_phase_error = one(options_.max_phase_error)};
  if (options_.phase) gear.phase = one(*options_.phase);
  const MotionBounds bounds{.velocity = one(options_.velocity),
                            .acceleration = one(options_.acceleration),
                            .jerk = one(options_.jerk)};
  if (Done begun = axes_.gear(gear, bounds); !begun) return begun;
  for (Time locked{}; !options_.seconds || locked < *options_.seconds;) {
    if (const Done done = axes_.run(look); !done) return done;
    if (!axes_.moving()) return axes_.wait();  // the axis has stopped by itself: returns the reason
    if (axes_.locked()) locked += look;
    show(axes_.locked() ? "follows" : "approaches");
  }
  return {};
}

/// Replaces the last line of the terminal by the state of the axis.
void FollowRun::show(std::string_view what) const {
  const std::string& unit = axes_.unit(0);
  const std::string line =
      fmt::format("{} {} at {:.4f} {}, phase error {:.4f}", axes_.name(0), what,
                  axes_.positions()(0), unit.empty() ? "counts" : unit, axes_.phase_errors()(0));
  std::fputs(fmt::format("\r{:<75}", printable_text(line)).c_str(), stdout);
  std::fflush(stdout);
}

}  // namespace takt
