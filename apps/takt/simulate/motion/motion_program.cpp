#include "apps/takt/simulate/motion/motion_program.hpp"

#include <fmt/format.h>
#include <utility>

#include "apps/axis/group/surroundings.hpp"

namespace takt {
namespace {

using namespace std::chrono_literals;

constexpr Time until_bus_comes = std::chrono::hours{10'000};

Time program_time() { return surroundings().now(); }

std::string_view result_of(Obstacle::Kind kind) noexcept {
  using enum Obstacle::Kind;
  switch (kind) {
    case wrong_use:
      return "wrong_use";
    case no_bus:
      return "no_bus";
    case blocked:
      return "blocked";
    case refused:
      return "refused";
    case stopped:
    case interrupted:
      return "stopped";
    case time_over:
      return "time_over";
    case restarted:
      return "restarted";
  }
  return "blocked";
}

}  // namespace

MotionProgram::MotionProgram(Setting setting, const MotionScript& script,
                             std::span<const MotionEntry> entries,
                             std::span<MotionOutcome> outcomes)
    : setting_{std::move(setting)}, script_{script}, entries_{entries}, outcomes_{outcomes} {}

void MotionProgram::run() {
  if (!open()) return;
  for (; next_ < entries_.size() && !setting_.is_killed(); ++next_) {
    const MotionEntry& entry = entries_[next_];
    if (entry.at) {
      pass_until(*entry.at);
    } else {
      wait_for_end();
    }
    if (!setting_.is_killed()) take(entry, outcomes_[next_]);
  }
  pass_until(never);
}

/// Waits for the bus. Returns false if the program is killed meanwhile.
bool MotionProgram::open() {
  axes_.reset();
  auto opened =
      Axes::open(setting_.connect(), {.bus = setting_.bus,
                                      .names = script_.axes,
                                      .sender = script_.program,
                                      .longest = until_bus_comes,
                                      .interrupted = [this] {
                                        return setting_.is_killed() ||
                                               (interrupt_ && program_time() >= *interrupt_);
                                      }});
  if (opened) axes_.emplace(std::move(*opened));
  return opened.has_value();
}

/// Waits until `when`. Meanwhile, the motion of the newest entry continues.
void MotionProgram::pass_until(Time when) {
  while (program_time() < when && !setting_.is_killed()) {
    const auto left = when - program_time();
    const Done done = newest_ != nullptr ? axes_->wait(left) : axes_->run(left);
    if (newest_ != nullptr && (done || done.error().kind != Obstacle::Kind::time_over)) {
      settle(*std::exchange(newest_, nullptr), done);
    }
    const bool lost = !done && done.error().kind == Obstacle::Kind::restarted;
    if (lost && !open()) return;
  }
}

void MotionProgram::wait_for_end() {
  while (newest_ != nullptr && !setting_.is_killed()) pass_until(program_time() + 1s);
}

void MotionProgram::take(const MotionEntry& entry, MotionOutcome& outcome) {
  outcome.begin = program_time();
  outcome.result = "running";
  const std::string next = fmt::format("the entry in line {} ended it", entry.pos.line);
  if (goes_on(entry.kind)) {
    end_newest("replaced", next);
  } else if (entry.kind != MotionKind::enable && entry.kind != MotionKind::reset) {
    end_newest("stopped", next);
  }
  const Done done = command(entry, outcome);
  if (setting_.is_killed()) return;
  if (done && goes_on(entry.kind)) {
    newest_ = &outcome;
  } else {
    settle(outcome, done);
  }
  if (!done && done.error().kind == Obstacle::Kind::restarted) open();
}

Done MotionProgram::command(const MotionEntry& entry, MotionOutcome& outcome) {
  using enum MotionKind;
  switch (entry.kind) {
    case enable:
      return axes_->enable();
    case reset:
      return axes_->reset();
    case move:
      return axes_->begin_move(entry.values, entry.bounds);
    case move_by:
      return this->move_by(entry);
    case jog:
      return axes_->jog(entry.values, entry.bounds);
    case gear:
      return axes_->gear(entry.gear, entry.bounds);
    case stream:
      return this->stream(entry, outcome);
    case stop:
      return axes_->stop();
    case home:
      return axes_->home();
    case disable:
      return axes_->disable();
    case kill:
      break;
  }
  return {};
}

std::optional<Time> MotionProgram::time_of_next() const {
  return next_ + 1 < entries_.size() ? entries_[next_ + 1].at : std::nullopt;
}

/// Returns when the motion has ended, or at the time of the next entry. The motion itself then goes
/// on.
Done MotionProgram::move_by(const MotionEntry& entry) {
  interrupt_ = time_of_next();
  const Done done = axes_->move_by(entry.values, entry.bounds);
  interrupt_.reset();
  const bool moves_on = !done && done.error().kind == Obstacle::Kind::interrupted;
  return moves_on ? Done{} : done;
}

/// Gives the points to the library, which waits while it has no room for more. The next entry of
/// the script ends this wait, and the library then stops the axes.
Done MotionProgram::stream(const MotionEntry& entry, MotionOutcome& outcome) {
  if (Done begun = axes_->begin_stream(entry.bounds); !begun) return begun;
  interrupt_ = time_of_next();
  Done given = axes_->stream(entry.points);
  interrupt_.reset();
  if (!given && given.error().kind == Obstacle::Kind::interrupted) {
    outcome.by_script = true;
    given.error().text = fmt::format("the entry in line {} ended it", entries_[next_ + 1].pos.line);
  }
  return given;
}

void MotionProgram::end_newest(std::string_view result, std::string text) {
  if (newest_ == nullptr) return;
  MotionOutcome& outcome = *std::exchange(newest_, nullptr);
  outcome.end = program_time();
  outcome.result = result;
  outcome.by_script = true;
  outcome.text = std::move(text);
}

void MotionProgram::settle(MotionOutcome& outcome, const Done& done) {
  if (setting_.is_killed()) return;
  outcome.end = program_time();
  outcome.result = done ? "done" : result_of(done.error().kind);
  if (done) return;
  outcome.text = done.error().text;
  outcome.by_script |= program_time() >= setting_.end_of_run;
}

}  // namespace takt
