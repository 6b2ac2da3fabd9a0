#include "apps/takt/soak/random_program_faults.hpp"

#include <algorithm>
#include <utility>

#include "apps/takt/soak/soak_trace.hpp"

namespace takt::soak {

using namespace std::chrono_literals;

namespace {

constexpr Time aftermath = 1500ms;

}  // namespace

RandomProgramFaults::RandomProgramFaults(Cast cast, sim::Random random, const Span& span,
                                         std::function<void(Time until)> disturbed, bool verbose)
    : cast_{cast},
      random_{random},
      next_{span.from},
      until_{span.until},
      mean_pause_{span.mean_pause},
      disturbed_{std::move(disturbed)},
      verbose_{verbose} {}

/// Returns the duration of a fault: mostly short, sometimes longer than every time to live.
Time RandomProgramFaults::span() {
  switch (random_.below(8)) {
    case 0:
      return 1s + random_.up_to(8s);
    case 1:
    case 2:
      return random_.up_to(1s);
    default:
      return random_.up_to(60ms);
  }
}

VirtualApplication& RandomProgramFaults::application() {
  return *cast_.applications[random_.below(static_cast<std::uint32_t>(cast_.applications.size()))];
}

Time RandomProgramFaults::next() const noexcept { return std::min(next_, agenda_.next()); }

void RandomProgramFaults::act(Time now) {
  agenda_.act(now);
  if (next_ > now) return;
  begin(now);
  next_ = now + random_.up_to(2 * mean_pause_);
  if (next_ >= until_) next_ = never;
}

void RandomProgramFaults::begin(Time now) {
  ++count_;
  switch (random_.below(13)) {
    case 0:
    case 1:
      return stall_front(now);
    case 2:
    case 3:
      return stall_process(now);
    case 4:
      daemon_dies_ = cast_.daemon.runs();
      return announce(now, "taktd dies", {});
    case 5:
      return stall_application(now);
    case 6:
      return kill_application(now);
    case 7:
      return bring_rival(now);
    case 8:
      return slow_down_lcm(now);
    case 9:
      announce(now, "replay", {});
      return cast_.forger.replay(now);
    case 10:
      cast_.clocks.set_wall(std::chrono::days{20454} + random_.up_to(2s) - 1s);
      return announce(now, "the wall clock is set", {});
    case 11:
      return let_jump(now);
    default:
      announce(now, "forged messages", {});
      for (std::uint32_t i = 1 + random_.below(10); i != 0; --i) cast_.forger.act_up(now);
  }
}

void RandomProgramFaults::stall_front(Time now) {
  const Time stall = span();
  announce(now, "the front thread is stalled", stall);
  cast_.daemon.stall(now + stall);
}

/// Stalls both threads of taktd, as SIGSTOP does. It is random which of them continues first, and
/// an application may die meanwhile.
void RandomProgramFaults::stall_process(Time now) {
  const Time stall = span();
  announce(now, "taktd is stopped", stall);
  cast_.world.add({.kind = sim::FaultKind::stall_master, .at = now, .until = now + stall});
  cast_.daemon.stall(now + stall + random_.up_to(300us));
  if (random_.chance(0.3))
    agenda_.add(now + stall / 2, [this, at = now + stall / 2] { kill_application(at); });
}

void RandomProgramFaults::daemon_died(Time now) {
  daemon_dies_ = false;
  agenda_.add(now + 20ms + span(), [this] { cast_.daemon.start(); });
}

void RandomProgramFaults::stall_application(Time now) {
  const Time stall = span();
  announce(now, "an application is stalled", stall);
  application().stall(now + stall);
}

/// Lets the set-points of an application jump, by little more than their limits permit or by far
/// more.
void RandomProgramFaults::let_jump(Time now) {
  const std::int64_t counts = std::int64_t{16} << random_.below(16);
  announce(now, "an application commands a jump", {});
  application().jump(random_.chance(0.5) ? counts : -counts);
}

void RandomProgramFaults::kill_application(Time now) {
  VirtualApplication& one = application();
  if (!one.runs()) return;
  const Time away = 20ms + span();
  const bool in_order = random_.chance(0.5);
  announce(now, in_order ? "an application ends" : "an application dies", away);
  if (in_order) {
    one.end(now);
  } else {
    one.kill();
  }
  agenda_.add(now + away, [&one] { one.start(); });
}

void RandomProgramFaults::bring_rival(Time now) {
  if (cast_.rival.runs()) return;
  const Time stay = span();
  announce(now, "a second program of the same name starts", stay);
  cast_.rival.start();
  agenda_.add(now + stay, [this] { cast_.rival.kill(); });
}

void RandomProgramFaults::slow_down_lcm(Time now) {
  const Time lasts = span();
  announce(now, "messages are delayed", lasts);
  cast_.lcm.set_delay(1ms + random_.up_to(300ms));
  agenda_.add(now + lasts, [this] { cast_.lcm.set_delay(VirtualLcm::usual_delay); });
}

/// Reports a fault. Its effects last longer than the fault, because messages that were sent during
/// the fault may arrive or expire later.
void RandomProgramFaults::announce(Time now, const char* what, Time span) const {
  disturbed_(now + span + aftermath);
  if (!verbose_) return;
  const double ms = 1e-6 * static_cast<double>(span.count());
  print_at(now, span == Time{} ? what : fmt::format("{} for {:.3f} ms", what, ms));
}

}  // namespace takt::soak
