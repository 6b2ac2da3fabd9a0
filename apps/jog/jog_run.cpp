#include "apps/jog/jog_run.hpp"

#include <cmath>
#include <cstdio>
#include <fmt/format.h>

#include "master/lcm/printable_text.hpp"

namespace takt {
namespace {

/// Time to the full velocity without --acceleration, seconds.
constexpr double usual_ramp = 0.25;
/// Period in which the program reads the keyboard.
constexpr std::chrono::milliseconds look{10};
/// If the program has not read the keyboard for longer than this, it discards the keys that have
/// come meanwhile: they may be older than the release of the key.
constexpr std::chrono::milliseconds oldest_key{100};

Time now() { return std::chrono::steady_clock::now().time_since_epoch(); }

/// A speed axis without --acceleration follows the ramps of its drive.
double usual_acceleration(const Axes& axes, const JogOptions& options) {
  const double usual = axes.has_positions() ? std::abs(options.velocity) / usual_ramp : 0.0;
  return options.acceleration.value_or(usual);
}

Eigen::VectorXd one(double value) { return Eigen::VectorXd::Constant(1, value); }

}  // namespace

JogRun::JogRun(Axes& axes, const JogOptions& options)
    : axes_{axes},
      options_{options},
      bounds_{.velocity = one(std::abs(options.velocity)),
              .acceleration = one(usual_acceleration(axes, options)),
              .jerk = one(options.jerk)},
      dead_man_{{.first = options.first, .next = options.dead_man}} {}

Done JogRun::run() {
  if (Done enabled = axes_.enable(); !enabled) return enabled;
  Done jogged = options_.seconds ? jog_for(*options_.seconds) : jog_by_keys();
  const Done disabled = axes_.disable();
  show("is disabled");
  std::puts("");
  const bool asked = !jogged && jogged.error().kind == Obstacle::Kind::interrupted;
  return jogged || asked ? disabled : jogged;
}

Done JogRun::jog_for(Time time) {
  Done done = turn_to(1);
  if (done) done = axes_.run(time);
  if (done && !axes_.moving()) done = axes_.wait();  // returns why the axis has stopped
  return done ? axes_.stop() : done;
}

Done JogRun::jog_by_keys() {
  Keyboard keyboard;
  last_look_ = now();
  while (!ends_ && keyboard.open()) {
    take_keys(keyboard);
    const int wanted = dead_man_.direction(now());
    Done done = axes_.run(look);
    if (done && direction_ != 0 && !axes_.moving()) done = axes_.wait();
    if (done && wanted != direction_) {
      done = turn_to(wanted);
      keyboard.forget();  // keys that have come meanwhile may be older than the release
      last_look_ = now();
    }
    show(direction_ == 0 ? "is stopped" : "moves");
    if (done) continue;
    const bool goes_on = done.error().kind == Obstacle::Kind::refused ||
                         done.error().kind == Obstacle::Kind::stopped;
    if (!goes_on) return done;
    std::fputs(fmt::format("\n{}\n", printable_text(done.error().text)).c_str(), stdout);
    direction_ = 0;
    dead_man_.release();
    if (const Done stopped = axes_.stop(); !stopped) return stopped;
  }
  return axes_.stop();
}

Done JogRun::turn_to(int direction) {
  direction_ = direction;
  return direction == 0 ? axes_.stop() : axes_.jog(one(direction * options_.velocity), bounds_);
}

void JogRun::take_keys(Keyboard& keyboard) {
  const Time looked = now();
  if (looked - last_look_ > oldest_key) keyboard.forget();
  last_look_ = looked;
  for (JogKey key = keyboard.next(); key != JogKey::none; key = keyboard.next()) {
    if (key == JogKey::forward || key == JogKey::backward) {
      dead_man_.press(key == JogKey::forward ? 1 : -1, looked);
    } else {
      dead_man_.release();
      ends_ |= key == JogKey::end;
    }
  }
}

/// Replaces the last line of the terminal by the state of the axis.
void JogRun::show(std::string_view what) const {
  const std::string& unit = axes_.unit(0);
  const double value = axes_.has_positions() ? axes_.positions()(0) : axes_.velocities()(0);
  const std::string line =
      fmt::format("{} {} at {:.4f} {}", axes_.name(0), what, value, unit.empty() ? "counts" : unit);
  std::fputs(fmt::format("\r{:<70}", printable_text(line)).c_str(), stdout);
  std::fflush(stdout);
}

}  // namespace takt
