#include "apps/logic/logic_run.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <fmt/format.h>
#include <fstream>
#include <utility>

#include "apps/command_line/finding_text.hpp"
#include "master/lcm/printable_text.hpp"

namespace takt {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::milliseconds tick{20};
/// The time for which the program waits for the message that names the inverters of the bus. taktd
/// sends this message once a second.
constexpr std::chrono::milliseconds layout_time{1500};
constexpr std::int32_t controlword = 0x6040;
/// Distance of the objects of the next axis of a device. CiA 402-2.
constexpr std::int32_t next_axis = 0x800;

bool is_controlword(const signal_t& signal) {
  const std::int32_t above = signal.index - controlword;
  return signal.output && above >= 0 && above < 8 * next_axis && above % next_axis == 0;
}

Obstacle obstacle(Obstacle::Kind kind, std::string text) {
  return Obstacle{.kind = kind, .text = std::move(text)};
}

}  // namespace

LogicRun::LogicRun(AxisGroup& group, const LogicOptions& options, std::vector<Rule> rules,
                   std::function<bool()> interrupted)
    : group_{group},
      options_{options},
      rules_{std::move(rules)},
      interrupted_{std::move(interrupted)} {}

Done LogicRun::run() {
  const std::string& file = options_.program.plot;
  if (!file.empty() && !std::ofstream{file}.good()) {
    return std::unexpected{obstacle(Obstacle::Kind::wrong_use, "--plot: can't write " + file)};
  }
  const Done done = follow();
  group_.release();
  return done && program_ ? write_plot() : done;
}

Done LogicRun::write_plot() const {
  const std::string& file = options_.program.plot;
  if (file.empty()) return {};
  std::ofstream picture{file};
  picture << plot_svg(trace_.plot("takt-logic", program_->names()));
  picture.close();
  if (picture.good()) return {};
  return std::unexpected{obstacle(Obstacle::Kind::blocked, "--plot: can't write " + file)};
}

Done LogicRun::follow() {
  const auto begin = Clock::now();
  while (!interrupted_()) {
    const Input input = group_.wait(tick);
    report_events();
    if (input == Input::restarted) {
      if (program_) say("taktd has a new layout: the rules begin anew");
      program_.reset();
      continue;
    }
    const auto waited = Clock::now() - begin;
    if (input == Input::stale) say("no newer image comes: the outputs take their fallback");
    if (input != Input::fresh) {
      if (program_ || waited < options_.program.wait) continue;
      return std::unexpected{obstacle(Obstacle::Kind::no_bus,
                                      "no image of " +
                                          (group_.bus().empty() ? "a bus" : "bus " + group_.bus()) +
                                          " has come: is taktd running, with the same LCM URL?")};
    }
    if (!program_) {
      if (group_.speed_axes().empty() && waited < layout_time) continue;
      if (const Done bound = bind(); !bound) return bound;
    }
    step();
    if (options_.seconds && time_ >= *options_.seconds) break;
  }
  return {};
}

Done LogicRun::bind() {
  std::vector<std::int16_t> axes;
  for (const signal_t& signal : group_.input().signals()) {
    if (is_controlword(signal)) axes.push_back(signal.node_id);
  }
  for (const speed_axis_t& axis : group_.speed_axes()) {
    for (const signal_t& signal : group_.input().signals()) {
      if (signal.node == axis.node) axes.push_back(signal.node_id);
    }
  }
  Findings findings;
  program_.emplace(rules_, group_.input().signals(), axes, options_.file, findings);
  if (print_findings(findings)) {
    return std::unexpected{
        obstacle(Obstacle::Kind::wrong_use, "the rules do not fit bus " + group_.bus())};
  }
  reported_.assign(rules_.size(), 0.0);
  cycle_ = group_.input().cycle();
  say(fmt::format("bus {}: {} rules, {} outputs, SYNC every {:g} ms", group_.bus(), rules_.size(),
                  program_->outputs().size(),
                  std::chrono::duration<double, std::milli>(group_.period()).count()));
  return {};
}

void LogicRun::step() {
  const std::int64_t cycle = group_.input().cycle();
  const Time passed = group_.period() * std::max<std::int64_t>(cycle - cycle_, 0);
  cycle_ = cycle;
  time_ += passed;
  program_->step(group_.input(), passed);
  send();
  if (!options_.program.plot.empty()) {
    trace_.take(std::chrono::duration<double>(time_).count(), program_->values(group_.input()));
  }
  if (!options_.quiet) report_changes();
}

void LogicRun::send() {
  command_t command{};
  for (const auto& [signal, raw] : program_->outputs()) {
    command.signals.push_back(static_cast<std::int32_t>(signal));
    command.values.push_back(raw);
  }
  if (!command.values.empty()) group_.send_values(command);
}

void LogicRun::report_changes() {
  for (std::size_t i = 0; i < reported_.size(); ++i) {
    const double value = program_->value(i);
    if (std::exchange(reported_[i], value) == value) continue;
    say(rules_[i].kind == RuleKind::count
            ? fmt::format("{} = {:g}", rules_[i].target, value)
            : fmt::format("{} {}", rules_[i].target, value != 0.0 ? "on" : "off"));
  }
}

void LogicRun::report_events() {
  for (const event_t& event : group_.take_events()) {
    if (event.severity > 0) say(event.text);
  }
}

void LogicRun::say(const std::string& text) const {
  const std::string line =
      fmt::format("{:8.3f} s  {}\n", std::chrono::duration<double>(time_).count(), text);
  std::fputs(printable_lines(line).c_str(), stdout);
  std::fflush(stdout);
}

}  // namespace takt
