#include "apps/move/progress.hpp"

#include <cstdio>
#include <fmt/format.h>

#include "master/lcm/printable_text.hpp"

namespace takt {

void Progress::say(std::string_view text) {
  const std::chrono::duration<double> since = Clock::now() - start_;
  print(fmt::format("{:6.2f} s  {}\n", since.count(), text));
}

void Progress::print(std::string_view text) {
  std::fputs(printable_lines(text).c_str(), stdout);  // fmt::print throws if stdout is closed
  std::fflush(stdout);
}

void Progress::states(AxisGroup& group) {
  const AxisControl& axes = group.axes();
  const bool first = reported_.size() != static_cast<std::size_t>(axes.size());
  reported_.resize(static_cast<std::size_t>(axes.size()), State402::not_ready_to_switch_on);
  for (AxisControl::Index i = 0; i < axes.size(); ++i) {
    State402& reported = reported_[static_cast<std::size_t>(i)];
    const State402 state = axes.drive(i).state();
    if (state == reported && !first) continue;
    reported = state;
    say(fmt::format("{:<12} {}  (statusword 0x{:04X})", axes.name(i), name(state),
                    axes.statusword(i)));
  }
  for (const event_t& event : group.take_events()) {
    stop_reasons_.take(event);
    if (event.severity > 0 && !reported_recently(event)) say(event.text);
  }
}

bool Progress::reported_recently(const event_t& event) {
  const auto now = Clock::now();
  auto& last = last_of_kind_[{event.node_id, event.kind}];
  const bool recently = last != Clock::time_point{} && now - last < std::chrono::seconds{2};
  if (!recently) last = now;
  return recently;
}

void Progress::positions(const AxisControl& axes, const Following& following,
                         std::string_view what) {
  const auto now = Clock::now();
  if (now < next_positions_) return;
  next_positions_ = now + std::chrono::milliseconds{250};
  std::string line = fmt::format("{:<8}", what);
  for (AxisControl::Index i = 0; i < axes.size(); ++i) {
    line += fmt::format("  {} {:9.4f} {} (error {:+.4f})", axes.name(i), axes.positions()(i),
                        units_[static_cast<std::size_t>(i)], following.error()(i));
  }
  say(line);
}

}  // namespace takt
